"""Gathers episodes with random arguments, one lock-step run each, in Parquet parts.

Each episode has its own random generator, seeded by stream, seed, action and number. So any number of processes and any
order give the same bits, and evaluation never uses training episodes.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.cards.episodes_shape import MAX_OBJECTS
from tailor.models.episodes.episodes import Episode, part_bytes, store_part
from tailor.models.episodes.manifest import write_manifest
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.tools.learning.gathering.beside_objects import check_sampler, runs_beside_objects
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec, columns_of, draw
from tailor.tools.learning.gathering.manifests import check_resumable, manifest_of, part_name
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.parallel.pool import completed

MAX_EPISODES = 1_000_000  # of a data set: the names of parts have six digits, and those of more would be in no order
MAX_NUMBER = 2**31  # of episodes in all, as their numbers have 32 bits
PART = 20  # episodes in a part: the most that a kill -9 loses, per process


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


def check_number(count: int, objects: int = 0) -> None:
    """Check a number of random episodes, or of runs beside `objects` that are noted after each.

    Raises:
      UsageError: It is beyond what can be stored.
    """
    if count > MAX_EPISODES:
        raise UsageError(f"{count} random episodes, expected at most {MAX_EPISODES}")
    if objects > MAX_OBJECTS:
        raise UsageError(f"{objects} objects beside each run, expected at most {MAX_OBJECTS}")
    if count * objects > MAX_NUMBER:
        raise UsageError(f"{count} runs beside {objects} objects each, expected at most {MAX_NUMBER} episodes in all")


def run_one(spec: DataSetSpec, domain: Domain, body: Any, number: int) -> Episode:
    """Run one episode; the same spec and number give the same bits."""
    rng = spec.rng(number)
    arguments = draw(spec, domain, rng)
    run = action_run.run_action(body, domain, spec.action, arguments, rng)
    ended = run.duration_s, run.success, run.failure, run.done, run.work_j
    return Episode(number, arguments, run.ticks, *ended, in_context=spec.beside)


def run_episodes(spec: DataSetSpec, domain: Domain, body: Any, runs: Sequence[int]) -> tuple[list[Episode], float]:
    """The episodes of these runs, in order, and the simulated seconds; a run gives one episode, or one an object."""
    if spec.objects:
        return runs_beside_objects(spec.objects, domain, spec.action, body, runs, spec.rng)
    episodes = [run_one(spec, domain, body, number) for number in runs]
    return episodes, sum(episode.duration_s for episode in episodes)


def part_of(spec: DataSetSpec, first: int) -> tuple[bytes, float, float]:
    """The part that starts with episode `first`: its file, simulated seconds and wall seconds.

    Writing Parquet takes tens of milliseconds, so it belongs to the part: files of many workers are only stored.
    """
    domain, started = domains.load(spec.domain), time.perf_counter()
    body = body_of(spec.domain, spec.profile)
    numbers = range(first, min(first + PART, spec.episodes))
    episodes, simulated_s = run_episodes(spec, domain, body, numbers)
    names = [entry["name"] for entry in columns_of(spec, domain)]
    return part_bytes(episodes, names), simulated_s, time.perf_counter() - started


def part_path(spec: DataSetSpec, first: int) -> Path:
    """Path of the part that starts with episode `first`."""
    return spec.folder / part_name(first, min(first + PART, spec.episodes))


def missing_parts(spec: DataSetSpec) -> list[int]:
    """First episodes of the parts that are missing."""
    return [first for first in range(0, spec.episodes, PART) if not part_path(spec, first).exists()]


def missing_episodes(spec: DataSetSpec) -> int:
    """Number of the episodes in the parts that are missing."""
    return sum(min(PART, spec.episodes - first) for first in missing_parts(spec))


def prepare(spec: DataSetSpec, resume: bool) -> None:
    """See `prepare_all`."""
    prepare_all([spec], resume)


def prepare_all(specs: Sequence[DataSetSpec], resume: bool) -> None:
    """Create folders with their manifests, or check that they can be resumed.

    All are checked before the first one is made: a folder without episodes would pass for a data set.

    Raises:
      UsageError: A folder holds another data set or a larger one, or the same one without `resume`; or the robot's
        sampler draws no objects where some are asked for; or there are too many episodes.
    """
    manifests = [_checked(spec, resume) for spec in specs]
    for spec, manifest in zip(specs, manifests, strict=True):
        _make(spec, manifest)


def _checked(spec: DataSetSpec, resume: bool) -> dict[str, Any]:
    """The manifest of a data set that can be gathered."""
    check_number(spec.episodes, spec.objects)
    if spec.beside:
        check_sampler(domains.load(spec.domain), spec.objects)
    manifest = manifest_of(spec)
    check_resumable(spec.folder, manifest, resume)
    return manifest


def _make(spec: DataSetSpec, manifest: dict[str, Any]) -> None:
    spec.folder.mkdir(parents=True, exist_ok=True)
    expected = {part_path(spec, first).name for first in range(0, spec.episodes, PART)}
    for path in (*spec.folder.glob("*.tmp"), *spec.folder.glob("part-*.parquet")):
        if path.name not in expected:
            path.unlink()  # incomplete, or a last part that was shorter
    write_manifest(spec.folder, manifest)


def gather(spec: DataSetSpec, parts: Sequence[int], jobs: int) -> Iterator[tuple[int, float, float]]:
    """Gather parts in parallel and write each as it completes.

    Yields:
      Of each written part: number of its draws, simulated seconds and wall seconds.
    """
    for number, (file, simulated_s, wall_s) in completed(part_of, [(spec, first) for first in parts], jobs):
        first = parts[number]
        store_part(part_path(spec, first), file)
        yield min(PART, spec.episodes - first), simulated_s, wall_s
