"""Manifests of gathered data sets: their entries, and whether a folder can be resumed."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.context_columns import CONTEXT
from tailor.models.episodes.manifest import MANIFEST, read_manifest
from tailor.models.episodes.sources import short_hashes
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.episode_files import episode_files
from tailor.schemas.installed.source import episodes_sha256
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec, columns_of, draw

RANGE_DRAWS = 4096  # samples that determine the ranges of the controller's arguments
RANGE_STEP = 0.05  # ranges are rounded outwards to multiples of it
# entries of a manifest that may differ when a data set is resumed; `source_sha256` stands for the files
COUNTS = ("episodes", "runs", "software", "source_files")


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
        "source": "lock-step, random arguments" + (" beside one object" if spec.beside else ""),
        **source_entries(spec.domain),
        "on_policy": 0,
        "software": {name: version(name) for name in ("tailor", "mujoco", "numpy")},
    }


def context_entry(domain: Domain, action: str, names: Sequence[str]) -> dict[str, Any]:
    """Manifest entry of an action with a context: names of the further columns, and the failure of the object."""
    context = domain.actions[action].context
    return {} if context is None else {CONTEXT: {"names": list(names), "failure": context.failure}}


def source_entries(domain: str) -> dict[str, Any]:
    """Entries of a manifest that state the source that episodes are simulated with."""
    return {"source_sha256": episodes_sha256(domain), "source_files": short_hashes(episode_files(domain))}


def argument_ranges(domain: Domain, spec: DataSetSpec) -> list[dict[str, Any]]:
    """Name, unit and range of each column of a data set's arguments, from samples."""
    rng = np.random.default_rng(0)
    drawn = np.stack([draw(spec, domain, rng) for _ in range(RANGE_DRAWS)])
    low, high = np.floor(drawn.min(axis=0) / RANGE_STEP), np.ceil(drawn.max(axis=0) / RANGE_STEP)
    return [
        {**column, "lower": round(a * RANGE_STEP, 9), "upper": round(b * RANGE_STEP, 9)}
        for column, a, b in zip(columns_of(spec, domain), low.tolist(), high.tolist(), strict=True)
    ]


def check_resumable(folder: Path, manifest: dict[str, Any], resume: bool) -> None:
    """Check that a data set can be gathered into a folder, or resumed there.

    Raises:
      UsageError: The folder holds another data set or a larger one, or the same one without `resume`.
    """
    if not (folder / MANIFEST).exists():
        return
    if not resume:
        raise UsageError(f"{folder}: holds episodes already (expected another --out, or --resume to continue)")
    existing = read_manifest(folder)
    for key, value in manifest.items():
        if key not in COUNTS and existing.get(key) != value:
            raise UsageError(f"{folder}: was gathered with {key} = {existing.get(key)!r}, expected {value!r} to resume")
    if manifest["episodes"] < existing.get("episodes", 0):  # resuming must not delete finished episodes
        raise UsageError(
            f"{folder}: --episodes is {manifest['episodes']}, expected at least {existing['episodes']} "
            "as the folder was made for, to resume"
        )
