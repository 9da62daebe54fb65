"""Makes episodes part by part: random arguments, one lock-step run each, a Parquet part every few episodes.

Every episode has a generator of its own, seeded by its purpose, the seed, the action and its number: any number of
processes and any order give the same bits, and what is evaluated was never trained on.
"""

from __future__ import annotations

import hashlib
import time
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.manifest import MANIFEST, read_manifest, write_manifest
from tailor.schemas.errors import UsageError
from tailor.tools.lockstep import action_run

TRAINING_STREAM, EVALUATION_STREAM, NOISE_STREAM, POLICY_STREAM = 10, 11, 12, 13  # first word of every seed
PART = 20  # episodes in a part: what a kill -9 loses at most, per process
RANGE_DRAWS = 4096  # to learn the ranges of the arguments as the controller gets them
COUNTS = ("episodes", "runs", "software")  # of a manifest: may differ when a data set is gone on with
RANGE_STEP = 0.05  # to which they are rounded outwards
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True, slots=True)
class DataSetSpec:
    """One data set to make."""

    domain: str
    action: str
    episodes: int
    seed: int
    folder: Path
    stream: int = TRAINING_STREAM

    def rng(self, number: int) -> np.random.Generator:
        """The generator of one episode: its arguments and all its noise."""
        return np.random.default_rng([self.stream, self.seed, zlib.crc32(self.action.encode()), number])


def domain_of(robot: str) -> str:
    """Name of the domain that a robot acts in; raises UsageError listing the robots."""
    known = {domains.load(name).robot: name for name in domains.DOMAINS}
    if robot not in known:
        raise UsageError(f"no robot '{robot}' (expected one of: {', '.join(known)})")
    return known[robot]


def check_action(domain: str, action: str) -> None:
    """Raises UsageError, listing a domain's actions, where there is none of that name."""
    known = domains.load(domain).actions
    if action not in known:
        raise UsageError(f"no action '{action}' in {domain} (expected one of: {', '.join(known)})")


def run_one(spec: DataSetSpec, domain: Domain, body: Any, number: int) -> Episode:
    """Run one episode; the same spec and number give the same bits."""
    rng = spec.rng(number)
    arguments = action_run.sample_arguments(domain, spec.action, rng)
    run = action_run.run_action(body, domain, spec.action, arguments, rng)
    return Episode(number, arguments, run.ticks, run.duration_s, run.success, run.failure, run.done, run.work_j)


def run_part(spec: DataSetSpec, first: int) -> tuple[int, float, float]:
    """Make the part that starts with episode `first`; returns episodes, simulated and wall seconds."""
    domain, started = domains.load(spec.domain), time.perf_counter()
    body = action_run.new_body(domain)
    made = [run_one(spec, domain, body, number) for number in range(first, min(first + PART, spec.episodes))]
    write_part(part_path(spec, first), made, argument_names(domain, spec.action))
    return len(made), sum(episode.duration_s for episode in made), time.perf_counter() - started


def part_path(spec: DataSetSpec, first: int) -> Path:
    """Where the part that starts with episode `first` lies: part-000020-000040.parquet holds 20 to 39."""
    return spec.folder / f"part-{first:06d}-{min(first + PART, spec.episodes):06d}.parquet"


def missing_parts(spec: DataSetSpec) -> list[int]:
    """First episodes of the parts that are still to be made."""
    return [first for first in range(0, spec.episodes, PART) if not part_path(spec, first).exists()]


def argument_names(domain: Domain, action: str) -> list[str]:
    """Names of the controller's arguments."""
    return [parameter.name for parameter in domain.actions[action].parameters]


def prepare(spec: DataSetSpec, resume: bool) -> None:
    """Make the folder with its manifest, or check that it is the one to go on with.

    Raises:
      UsageError: The folder holds another data set or a larger one, or the same one without `resume`.
    """
    manifest = _manifest(spec)
    check_resumable(spec.folder, manifest, resume)
    spec.folder.mkdir(parents=True, exist_ok=True)
    expected = {part_path(spec, first).name for first in range(0, spec.episodes, PART)}
    for path in (*spec.folder.glob("*.tmp"), *spec.folder.glob("part-*.parquet")):
        if path.name not in expected:
            path.unlink()  # half-written, or a last part that was shorter
    write_manifest(spec.folder, manifest)


def check_resumable(folder: Path, manifest: dict[str, Any], resume: bool) -> None:
    """Whether the data set that `manifest` describes may be made in a folder, or gone on with there.

    Raises:
      UsageError: The folder holds another data set or a larger one, or the same one without `resume`.
    """
    if not (folder / MANIFEST).exists():
        return
    if not resume:
        raise UsageError(f"{folder}: holds episodes already (expected another --out, or --resume to go on)")
    found = read_manifest(folder)
    for key, value in manifest.items():
        if key not in COUNTS and found.get(key) != value:
            raise UsageError(f"{folder}: was gathered with {key} = {found.get(key)!r}, expected {value!r} to resume")
    if manifest["episodes"] < found.get("episodes", 0):  # to go on must not throw finished ones away
        raise UsageError(
            f"{folder}: --episodes is {manifest['episodes']}, expected at least {found['episodes']} "
            "as the folder was made for, to resume"
        )


def _manifest(spec: DataSetSpec) -> dict[str, Any]:
    domain = domains.load(spec.domain)
    return {
        "robot": domain.robot,
        "domain": spec.domain,
        "action": spec.action,
        "arguments": argument_ranges(domain, spec.action),
        "episodes": spec.episodes,
        "seed": spec.seed,
        "stream": spec.stream,
        "source": "lock-step, random arguments",
        "source_sha256": source_hash(domain.robot, spec.domain),
        "on_policy": 0,
        "software": {name: version(name) for name in ("tailor", "mujoco", "numpy")},
    }


def argument_ranges(domain: Domain, action: str) -> list[dict[str, Any]]:
    """Name, unit and range of each controller argument, as sampling gives them."""
    rng = np.random.default_rng(0)
    drawn = np.stack([action_run.sample_arguments(domain, action, rng) for _ in range(RANGE_DRAWS)])
    low, high = np.floor(drawn.min(axis=0) / RANGE_STEP), np.ceil(drawn.max(axis=0) / RANGE_STEP)
    return [
        {"name": p.name, "unit": p.unit, "lower": round(a * RANGE_STEP, 9), "upper": round(b * RANGE_STEP, 9)}
        for p, a, b in zip(domain.actions[action].parameters, low.tolist(), high.tolist(), strict=True)
    ]


def source_hash(robot: str, domain: str) -> str:
    """SHA-256 over the source of controllers, belief, domain and body: another hash, another robot to learn."""
    folders = ("executive/actions", "executive/belief", f"executive/domains/{domain}", f"simnodes/{robot}")
    digest = hashlib.sha256()
    for path in sorted(path for folder in folders for path in (ROOT / folder).glob("*.py")):
        digest.update(path.relative_to(ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def gather(spec: DataSetSpec, parts: Sequence[int], jobs: int) -> Iterator[tuple[int, float, float]]:
    """Make parts in parallel, on whatever joblib backend is active; yields what `run_part` returns, as it comes."""
    from joblib import Parallel, delayed

    yield from Parallel(n_jobs=jobs, return_as="generator_unordered")(delayed(run_part)(spec, p) for p in parts)
