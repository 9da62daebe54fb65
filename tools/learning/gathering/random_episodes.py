"""Gathers episodes with random arguments, one lock-step run each, in Parquet parts.

Each episode has its own random generator, seeded by stream, seed, action and number. So any number of processes and any
order give the same bits, and evaluation never uses training episodes.
"""

from __future__ import annotations

import time
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.context_columns import CONTEXT
from tailor.models.episodes.episodes import Episode, part_bytes, store_part
from tailor.models.episodes.manifest import MANIFEST, read_manifest, write_manifest
from tailor.models.episodes.sources import short_hashes
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.schemas.installed.episode_files import episode_files
from tailor.schemas.installed.source import episodes_sha256
from tailor.tools.learning.gathering.beside_objects import runs_beside_objects
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.parallel.pool import completed

TRAINING_STREAM, EVALUATION_STREAM, NOISE_STREAM, POLICY_STREAM = 10, 11, 12, 13  # first word of every seed
PART = 20  # episodes in a part: the most that a kill -9 loses, per process
RANGE_DRAWS = 4096  # samples that determine the ranges of the controller's arguments
# entries of a manifest that may differ when a data set is resumed; `source_sha256` stands for the files
COUNTS = ("episodes", "runs", "software", "source_files")
RANGE_STEP = 0.05  # ranges are rounded outwards to multiples of it


@dataclass(frozen=True, slots=True)
class DataSetSpec:
    """One data set to gather: episodes of one action with random arguments.

    With `objects` of the action's context, each run gives as many episodes: see `beside_objects.py`.
    """

    domain: str
    action: str
    episodes: int
    seed: int
    folder: Path
    stream: int = TRAINING_STREAM
    beside: bool = False  # each episode beside one random object of the action's context
    objects: int = 0
    profile: str = ""  # of the body; empty: the one that ships

    def rng(self, number: int) -> np.random.Generator:
        """Random generator of one episode: its arguments and all its noise."""
        return np.random.default_rng([self.stream, self.seed, zlib.crc32(self.action.encode()), number])


def domain_of(robot: str) -> str:
    """Name of the domain of a robot.

    Raises:
      UsageError: There is no such robot.
    """
    return spec_of_robot(robot).name


def check_action(domain: str, action: str, beside: bool = False) -> None:
    """Check the name of an action, and that it has a context if it is gathered beside objects.

    Raises:
      UsageError: The domain has no such action, or the action no context.
    """
    declared = domains.load(domain).actions
    if action not in declared:
        raise UsageError(f"no action '{action}' in {domain} (expected one of: {', '.join(declared)})")
    if beside and declared[action].context is None:
        known = ", ".join(name for name, each in declared.items() if each.context is not None) or "none has one"
        raise UsageError(f"action '{action}' of {domain} has no context of objects (actions with one: {known})")


def run_one(spec: DataSetSpec, domain: Domain, body: Any, number: int) -> Episode:
    """Run one episode; the same spec and number give the same bits."""
    rng = spec.rng(number)
    arguments = _draw(spec, domain, rng)
    run = action_run.run_action(body, domain, spec.action, arguments, rng)
    return Episode(number, arguments, run.ticks, run.duration_s, run.success, run.failure, run.done, run.work_j)


def run_episodes(spec: DataSetSpec, domain: Domain, body: Any, runs: Sequence[int]) -> tuple[list[Episode], float]:
    """The episodes of these runs, in order, and the simulated seconds; a run gives one episode, or one an object."""
    if spec.objects:
        return runs_beside_objects(spec.objects, domain, spec.action, body, runs, spec.rng)
    episodes = [run_one(spec, domain, body, number) for number in runs]
    return episodes, sum(episode.duration_s for episode in episodes)


def _draw(spec: DataSetSpec, domain: Domain, rng: np.random.Generator) -> NDArray[np.float64]:
    """Arguments of one episode, with the row of its object if there is one."""
    arguments = action_run.sample_arguments(domain, spec.action, rng)
    return action_run.with_object(domain, spec.action, arguments, rng) if spec.beside else arguments


def part_of(spec: DataSetSpec, first: int) -> tuple[bytes, float, float]:
    """The part that starts with episode `first`: its file, simulated seconds and wall seconds.

    Writing Parquet takes tens of milliseconds, so it belongs to the part: files of many workers are only stored.
    """
    domain, started = domains.load(spec.domain), time.perf_counter()
    body = body_of(spec.domain, spec.profile)
    numbers = range(first, min(first + PART, spec.episodes))
    episodes, simulated_s = run_episodes(spec, domain, body, numbers)
    names = [entry["name"] for entry in _columns(spec, domain)]
    return part_bytes(episodes, names), simulated_s, time.perf_counter() - started


def part_path(spec: DataSetSpec, first: int) -> Path:
    """Path of the part that starts with episode `first`: part-000020-000040.parquet holds 20 to 39."""
    return spec.folder / f"part-{first:06d}-{min(first + PART, spec.episodes):06d}.parquet"


def missing_parts(spec: DataSetSpec) -> list[int]:
    """First episodes of the parts that are missing."""
    return [first for first in range(0, spec.episodes, PART) if not part_path(spec, first).exists()]


def argument_names(domain: Domain, action: str) -> list[str]:
    """Names of the controller's arguments."""
    return [parameter.name for parameter in domain.actions[action].parameters]


def context_entry(domain: Domain, action: str, names: Sequence[str]) -> dict[str, Any]:
    """Manifest entry of an action with a context: names of the further columns, and the failure of the object."""
    context = domain.actions[action].context
    return {} if context is None else {CONTEXT: {"names": list(names), "failure": context.failure}}


def prepare(spec: DataSetSpec, resume: bool) -> None:
    """Create the folder with its manifest, or check that it can be resumed.

    Raises:
      UsageError: The folder holds another data set or a larger one, or the same one without `resume`.
    """
    manifest = _manifest(spec)
    check_resumable(spec.folder, manifest, resume)
    spec.folder.mkdir(parents=True, exist_ok=True)
    expected = {part_path(spec, first).name for first in range(0, spec.episodes, PART)}
    for path in (*spec.folder.glob("*.tmp"), *spec.folder.glob("part-*.parquet")):
        if path.name not in expected:
            path.unlink()  # incomplete, or a last part that was shorter
    write_manifest(spec.folder, manifest)


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


def _manifest(spec: DataSetSpec) -> dict[str, Any]:
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


def source_entries(domain: str) -> dict[str, Any]:
    """Entries of a manifest that state the source that episodes are simulated with."""
    return {"source_sha256": episodes_sha256(domain), "source_files": short_hashes(episode_files(domain))}


def argument_ranges(domain: Domain, spec: DataSetSpec) -> list[dict[str, Any]]:
    """Name, unit and range of each column of a data set's arguments, from samples."""
    rng = np.random.default_rng(0)
    drawn = np.stack([_draw(spec, domain, rng) for _ in range(RANGE_DRAWS)])
    low, high = np.floor(drawn.min(axis=0) / RANGE_STEP), np.ceil(drawn.max(axis=0) / RANGE_STEP)
    return [
        {**column, "lower": round(a * RANGE_STEP, 9), "upper": round(b * RANGE_STEP, 9)}
        for column, a, b in zip(_columns(spec, domain), low.tolist(), high.tolist(), strict=True)
    ]


def _columns(spec: DataSetSpec, domain: Domain) -> list[dict[str, str]]:
    """Name and unit of the action's arguments; then those of the object beside it."""
    action = domain.actions[spec.action]
    named = [{"name": parameter.name, "unit": parameter.unit} for parameter in action.parameters]
    objects = action.context.columns if spec.beside and action.context is not None else ()
    return [*named, *({"name": column.name, "unit": column.unit} for column in objects)]


def gather(spec: DataSetSpec, parts: Sequence[int], jobs: int) -> Iterator[tuple[int, float, float]]:
    """Gather parts in parallel and write each as it completes.

    Yields:
      Of each written part: number of its draws, simulated seconds and wall seconds.
    """
    for number, (file, simulated_s, wall_s) in completed(part_of, [(spec, first) for first in parts], jobs):
        first = parts[number]
        store_part(part_path(spec, first), file)
        yield min(PART, spec.episodes - first), simulated_s, wall_s
