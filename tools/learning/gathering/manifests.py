"""Manifests of gathered data sets: their entries, and whether a folder can be resumed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.context_columns import CONTEXT
from tailor.models.episodes.manifest import MANIFEST, read_manifest
from tailor.models.episodes.sources import BESIDE_ONE, SELECTED, short_hashes
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.changed_source import differing_files
from tailor.schemas.installed.episode_files import episode_files
from tailor.schemas.installed.source import episodes_sha256
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec, columns_of, draw

Array = NDArray[np.float64]

RANGE_DRAWS = 4096  # samples that determine the ranges of the controller's arguments
RANGE_STEP = 0.05  # ranges are rounded outwards to multiples of it, in any unit of an argument,
MIN_STEPS, MAX_STEPS = 2, 400  # unless they had fewer or more of these steps
NEAR = 0.01  # of a declared range: samples that near to its end stand for the end itself
# entries of a manifest that may differ when a data set is resumed; `source_sha256` stands for the files
COUNTS = ("episodes", "runs", "software", "source_files")
NAMED = 3  # files that a message names
_PART = re.compile(r"part-(\d+)-(\d+)\.parquet")  # of random episodes: from the first to before the second
_RUNS = re.compile(r"runs-(\d+)-(\d+)\.done")  # the same of the executive's runs, beside the folders of their actions


def manifest_of(spec: DataSetSpec) -> dict[str, Any]:
    """Manifest of a data set of random episodes."""
    domain = domains.load(spec.domain)
    context = domain.actions[spec.action].context
    columns = context.names if spec.beside and context is not None else ()
    return {
        "robot": domain.robot,
        "domain": spec.domain,
        "action": spec.action,
        "arguments": argument_ranges(domain, spec),
        **(context_entry(domain, spec.action, columns) if columns else {}),
        **({"objects": spec.objects} if spec.objects else {}),
        **({"profile": spec.profile} if spec.profile else {}),
        "episodes": spec.episodes,
        "seed": spec.seed,
        "stream": spec.stream,
        "source": "lock-step, random arguments" + (BESIDE_ONE if spec.beside else ""),
        **source_entries(spec.domain),
        "on_policy": 0,
        "software": {name: version(name) for name in ("tailor", "mujoco", "numpy")},
    }


def context_entry(domain: Domain, action: str, names: Sequence[str]) -> dict[str, Any]:
    """Manifest entry of an action with a context: names of the further columns, and the failure of the object."""
    context = domain.actions[action].context
    return {} if context is None else {CONTEXT: {"names": list(names), "failure": context.failure}}


@lru_cache(maxsize=8)  # each action has a manifest of its own, and 200 files are parsed for the hashes: 0.3 s
def source_entries(domain: str) -> dict[str, Any]:
    """Entries of a manifest that state the source that episodes are simulated with; they are shared, not to change."""
    return {"source_sha256": episodes_sha256(domain), "source_files": short_hashes(episode_files(domain))}


def argument_ranges(domain: Domain, spec: DataSetSpec) -> list[dict[str, Any]]:
    """Name, unit and range of each column of a data set's arguments, from samples."""
    rng = np.random.default_rng(0)
    drawn = np.stack([draw(spec, domain, rng) for _ in range(RANGE_DRAWS)])
    lower, upper = _rounded(drawn.min(axis=0), drawn.max(axis=0))
    for k, parameter in enumerate(domain.actions[spec.action].parameters):
        near = NEAR * (parameter.upper - parameter.lower)
        if drawn[:, k].min() <= parameter.lower + near:
            lower[k] = min(lower[k], parameter.lower)
        if drawn[:, k].max() >= parameter.upper - near:
            upper[k] = max(upper[k], parameter.upper)
    return [
        {**column, "lower": round(a, 9), "upper": round(b, 9)}
        for column, a, b in zip(columns_of(spec, domain), lower.tolist(), upper.tolist(), strict=True)
    ]


def _rounded(lower: Array, upper: Array) -> tuple[Array, Array]:
    """Ends of ranges, shape (k,), rounded outwards; a step is `RANGE_STEP`, or tenths or tens of it, by the width."""
    width = np.where(upper > lower, upper - lower, 1.0)
    tenths = np.floor(np.log10(width / (MIN_STEPS * RANGE_STEP))).clip(max=0)
    tens = np.ceil(np.log10(width / (MAX_STEPS * RANGE_STEP))).clip(min=0)
    step = RANGE_STEP * 10.0 ** (tenths + tens)
    return np.floor(lower / step) * step, np.ceil(upper / step) * step


def check_resumable(folder: Path, manifest: dict[str, Any], resume: bool) -> None:
    """Check that a data set can be gathered into a folder, or resumed there.

    Raises:
      UsageError: The folder holds another data set or a larger one, or the same one without `resume`; or one of
        selected episodes, which does not grow; or parts without a manifest, which would pass for those of this one.
    """
    if not (folder / MANIFEST).exists():
        part = min(folder.glob("part-*.parquet"), default=None)
        if part is not None:
            raise UsageError(f"{part}: there is no {MANIFEST} beside it, expected one, or another --out")
        return
    if not resume:
        raise UsageError(
            f"{folder}: holds episodes already (expected another --out, or --resume to continue simulated runs)"
        )
    existing = read_manifest(folder)
    _check_source(folder, manifest, existing)
    selected = any(key in manifest for key in SELECTED)  # among a fixed number, which does not grow
    for key, value in manifest.items():
        if (key not in COUNTS or (selected and key == "episodes")) and existing.get(key) != value:
            raise UsageError(f"{folder}: was gathered with {key} = {existing.get(key)!r}, expected {value!r} to resume")
    if manifest["episodes"] < existing.get("episodes", 0):  # resuming must not delete finished episodes
        raise UsageError(
            f"{folder}: --episodes is {manifest['episodes']}, expected at least {existing['episodes']} "
            "as the folder was made for, to resume"
        )


def _check_source(folder: Path, manifest: Mapping[str, Any], existing: Mapping[str, Any]) -> None:
    """Raise UsageError if a data set was simulated with another source of its robot than the one to gather now."""
    before, today = existing.get("source_files") or {}, manifest.get("source_files", {})
    if existing.get("source_sha256") != manifest.get("source_sha256") and before:
        other = abbreviated(sorted(differing_files(before, today)), NAMED) or "source"
        raise UsageError(
            f"{folder}: was simulated with another {other}, expected today's to resume; "
            "gather anew with another --out, or into an emptied folder"
        )


def part_name(first: int, end: int) -> str:
    """Name of a part of random episodes: part-000020-000040.parquet holds 20 to 39."""
    return f"part-{first:06d}-{end:06d}.parquet"


def marker_name(first: int, end: int) -> str:
    """Name of the marker of finished runs; it holds their number, because a shorter last chunk may grow."""
    return f"runs-{first:06d}-{end:06d}.done"


def unfinished(folder: Path, manifest: Mapping[str, Any]) -> str:
    """How much of a data set was not gathered, as "3 of 9 runs", as far as names of files tell; empty if all was.

    They do not tell it of selected episodes, and of runs whose markers were left behind. Where more runs were asked for
    later, the marker of a shorter last chunk stays beside that of the whole one.
    """
    drawn = manifest.get("stream") is not None
    wanted, name, place = ("episodes", _PART, folder) if drawn else ("runs", _RUNS, folder.parent)
    finished = [(int(each[1]), int(each[2])) for path in place.iterdir() if (each := name.fullmatch(path.name))]
    count, total = _covered(finished), manifest.get(wanted) or 0
    return f"{total - count} of {total} runs" if finished and count < total else ""


def _covered(spans: Iterable[tuple[int, int]]) -> int:
    """How many numbers lie in any of the spans, each from its first to before its second number."""
    count = end = 0
    for first, last in sorted(spans):
        count, end = count + max(0, last - max(first, end)), max(end, last)
    return count
