"""Gathers episodes from whole runs: the executive's choices in lock-step (on-policy), or recordings of real robots.

Refinement prefers arguments where models err. On-policy episodes come from there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

from tailor.executive import domains
from tailor.executive.composition import load_models
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import ActionFinished, Contexts, ExecStatus, Message, Subgoals
from tailor.schemas.topics import TOPICS
from tailor.simnodes.world import World
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.random_episodes import DataSetSpec
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.episode_extraction import EpisodeExtractor
from tailor.tools.parallel.pool import completed
from tailor.tools.parallel.software import models_sha256

FIRST_SEED = 2_000_000_000  # of scenarios and noise; disjoint from the seeds of evaluations
CHUNK = 10  # runs whose episodes are written together
READ = (Subgoals, Contexts, ExecStatus, ActionFinished)  # besides sensors and ground truth
MAX_ACTIONS = 100  # per run; offset between the numbers of its episodes
UNPROVEN = RefinementSettings(certify_checks=0)  # certificates take time and do not change choices


@dataclass(frozen=True, slots=True)
class Policy:
    """Scenarios to run with the current models, and the folder of their data sets, one per action."""

    domain: str
    scenarios: tuple[str, ...]
    runs: int  # per scenario
    seed: int
    zoo: str
    folder: Path
    profile: str = ""  # of the body; empty: the one that ships

    @property
    def jobs(self) -> list[tuple[str, int]]:
        """Every run: scenario and a seed of its own, since scenarios of one seed share noise and the body's draws."""
        first = FIRST_SEED + 100_000 * self.seed
        count = self.runs * len(self.scenarios)
        return [(self.scenarios[k % len(self.scenarios)], first + k) for k in range(count)]


def run_policy(policy: Policy, jobs: int, resume: bool = True) -> Iterator[int]:
    """Run the missing runs in parallel; yields numbers of finished runs.

    Raises:
      UsageError: The folder holds other episodes, or the same ones without `resume`; or models fail their checks.
    """
    prepare_chosen(policy, {"source": "lock-step, refined choices", "episodes": policy.runs}, policy.jobs, resume)
    missing = [first for first in range(0, len(policy.jobs), CHUNK) if not _marker(policy, first).exists()]
    for number, cut in completed(_chunk, [(policy, first) for first in missing], jobs):
        first = missing[number]
        write(policy.domain, policy.folder, f"{first:06d}", cut)
        _marker(policy, first).touch()
        yield len(policy.jobs[first : first + CHUNK])


def models_hash(robot: str, zoo: str) -> str:
    """SHA-256 over the models that choose the arguments: other models give other episodes."""
    return models_sha256(cached_models(robot, zoo))


class Chosen(Protocol):
    """Data sets of choices by the current models; see `Policy` and `active_episodes.Active`."""

    @property
    def profile(self) -> str:
        """Of the body; empty: the one that ships."""
        ...

    @property
    def domain(self) -> str:
        """Name of the domain."""
        ...

    @property
    def scenarios(self) -> tuple[str, ...]:
        """Where they choose."""
        ...

    @property
    def seed(self) -> int:
        """Of situations and noise."""
        ...

    @property
    def zoo(self) -> str:
        """Folder of the models."""
        ...

    @property
    def folder(self) -> Path:
        """Folder of the data sets."""
        ...


def prepare_chosen(chosen: Chosen, about: dict[str, Any], runs: Sequence[Any], resume: bool) -> None:
    """Create the folders of data sets that models choose; see `prepare`."""
    entries = {
        **about,
        "seed": chosen.seed,
        "scenarios": list(chosen.scenarios),
        **({"profile": chosen.profile} if chosen.profile else {}),
        "models_sha256": models_hash(domains.load(chosen.domain).robot, chosen.zoo),
    }
    prepare(chosen.domain, chosen.folder, modelled_actions(chosen.domain), entries, runs, resume)


def prepare(
    domain: str, folder: Path, names: Sequence[str], about: dict[str, Any], runs: Sequence[Any], resume: bool
) -> None:
    """Create a data set folder with its manifest for each action.

    Raises:
      UsageError: One of them holds other episodes, or the same ones without `resume`; nothing is written then.
    """
    loaded = domains.load(domain)
    manifests = {
        folder / action: {
            "robot": loaded.robot,
            "domain": domain,
            "action": action,
            "arguments": random_episodes.argument_ranges(loaded, DataSetSpec(domain, action, 0, 0, folder)),
            **random_episodes.context_entry(loaded, action, names=()),
            "runs": len(runs),
            **random_episodes.source_entries(domain),
            "on_policy": True,
            **about,
        }
        for action in names
    }
    for place, manifest in manifests.items():
        random_episodes.check_resumable(place, manifest, resume)
    for place, manifest in manifests.items():
        place.mkdir(parents=True, exist_ok=True)
        write_manifest(place, manifest)


def modelled_actions(domain: str) -> list[str]:
    """Actions that have a duration model, which are the names of the data sets."""
    return sorted({action.duration_model.split("/")[0] for action in domains.load(domain).actions.values()})


def write(domain: str, folder: Path, part: str, cut: Sequence[tuple[str, Episode]]) -> None:
    """Write the episodes of some runs to the data sets of their actions."""
    loaded = domains.load(domain)
    for action in modelled_actions(domain):
        mine = [episode for name, episode in cut if name == action]
        if mine:
            names = random_episodes.argument_names(loaded, action)
            write_part(folder / action / f"part-{part}.parquet", mine, names)


def extract_from_recordings(domain: str, folder: Path, recordings: Sequence[Path]) -> dict[str, int]:
    """Extract data sets from recordings.

    Returns:
      Number of episodes by action.

    Raises:
      UsageError: A file is not a recording of an executive's run, none holds a finished action, two hold the same
        one, or the folder holds episodes already; nothing is written then.
    """
    robot = domains.load(domain)
    cut = [EpisodeExtractor(robot).read(_messages(path, _types_of(robot))) for path in recordings]
    if not any(cut):
        raise UsageError(f"{', '.join(map(str, recordings))}: no finished action, expected the recording of a run")
    _check_distinct(cut, recordings)
    about = {"source": "recordings", "recordings": [path.name for path in recordings]}
    counts = Counter(action for one in cut for action, _ in one)
    prepare(domain, folder, sorted(counts), about, recordings, resume=False)
    number = 0
    for one in cut:
        numbered = [(action, replace(e, number=number + k)) for k, (action, e) in enumerate(one)]
        write(domain, folder, f"{number:06d}", numbered)
        number += len(one)
    return {action: counts[action] for action in modelled_actions(domain)}


def _check_distinct(cut: Sequence[Sequence[tuple[str, Episode]]], recordings: Sequence[Path]) -> None:
    """Raise UsageError if two recordings, whatever their names, hold the same episode: test and training share it."""
    known: dict[tuple[str, bytes], Path] = {}
    for path, one in zip(recordings, cut, strict=True):
        keys = [(action, episode.ticks.tobytes()) for action, episode in one]
        for key in keys:
            if key in known:
                raise UsageError(f"{path}: holds the same {key[0]} as {known[key]}, expected each run once")
        known |= dict.fromkeys(keys, path)


def _types_of(domain: Domain) -> frozenset[type[Message]]:
    """Types of the messages that an extractor may read: the executive's, the robot's sensors, and ground truth."""
    truth = (name for name, topic in TOPICS.items() if topic.source == "simulator")
    return frozenset((*READ, *(TOPICS[name].type for name in (*domain.sensors, *truth))))


def _messages(path: Path, types: Collection[type[Message]]) -> Iterator[Message]:
    """Messages of the given types, in the order in which they were published."""
    from tailor.runtime.recordings.recording import open_recording
    from tailor.schemas.codec import decode
    from tailor.schemas.typesystem import type_of

    for recorded in sorted(open_recording(path).messages(), key=lambda m: m.publish_ns):
        kind = type_of(recorded.ros_type)
        if kind is not None and kind in types:
            message = decode(kind, recorded.data)
            if isinstance(message, Rejected):
                raise UsageError(f"{path}: {recorded.key} number {recorded.sequence}: {message.reason}")
            yield message


def _marker(policy: Policy, first: int) -> Path:
    """Marker of finished runs; the name holds their number, because a shorter last chunk may grow."""
    return policy.folder / f"runs-{first:06d}-{min(first + CHUNK, len(policy.jobs)):06d}.done"


def _chunk(policy: Policy, first: int) -> list[tuple[str, Episode]]:
    """Episodes of some runs, from number `first`, with the names of their actions."""
    cut = []
    for k, (scenario, seed) in enumerate(policy.jobs[first : first + CHUNK]):
        base = MAX_ACTIONS * (first + k)
        cut += [(a, replace(e, number=base + i)) for i, (a, e) in enumerate(_run(policy, scenario, seed))]
    return cut


def _run(policy: Policy, scenario: str, seed: int) -> list[tuple[str, Episode]]:
    from tailor.tools.lockstep.run import SENDER, run_lockstep

    domain = domains.load(policy.domain)
    drawn, start = domains.seeded_scenario(policy.domain, scenario, seed)
    settings = Settings(seed=seed, refinement=UNPROVEN)
    context = make_context(domain, drawn, cached_models(domain.robot, policy.zoo), settings, SENDER)
    world = World(body_of(policy.domain, policy.profile), start, seed)
    return EpisodeExtractor(domain).read(run_lockstep(context, world).messages)


@lru_cache(maxsize=2)
def cached_models(robot: str, zoo: str) -> Models:
    """Models, loaded once per process."""
    return load_models(robot, zoo)
