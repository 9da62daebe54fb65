"""Episodes out of whole runs: the executive's own choices in lock-step (on-policy), or recordings of real robots.

A model is wrong where it has not looked, and refinement goes exactly there; these episodes are from there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from executive import domains
from executive.core.context import Settings, make_context
from executive.library import Models
from executive.refinement.settings import RefinementSettings
from models.episodes import Episode, write_manifest, write_part
from models.runtime import load_robot
from schemas.errors import Rejected, UsageError
from schemas.messages import ActionFinished, ExecStatus, JointState, Message, Odometry, SimTruth, Subgoals
from tools import gathering, lockstep
from tools.cutting import Cutter

FIRST_SEED = 2_000_000_000  # of scenarios and noise; evaluations count from elsewhere
CHUNK = 10  # runs whose episodes are kept together
READ = (Subgoals, ExecStatus, SimTruth, JointState, Odometry, ActionFinished)
MOST_ACTIONS = 100  # of one run; spaces the numbers of its episodes
UNPROVEN = RefinementSettings(certify_checks=0)  # a proof of how good a choice is takes time and changes nothing


@dataclass(frozen=True, slots=True)
class Policy:
    """Scenarios to run with the current models, and where their episodes go: a data set per action."""

    domain: str
    scenarios: tuple[str, ...]
    runs: int  # of each scenario
    seed: int
    zoo: str
    folder: Path

    @property
    def jobs(self) -> list[tuple[str, int]]:
        """Every run: scenario and seed."""
        first = FIRST_SEED + 100_000 * self.seed
        return [(scenario, first + k) for k in range(self.runs) for scenario in self.scenarios]


def run_policy(policy: Policy, jobs: int) -> Iterator[int]:
    """Run what has not been run yet, in parallel; yields runs finished."""
    from joblib import Parallel, delayed

    about = {"source": "lock-step, refined choices", "seed": policy.seed, "scenarios": list(policy.scenarios)}
    prepare(policy.domain, policy.folder, {**about, "episodes": policy.runs}, policy.jobs)
    missing = [first for first in range(0, len(policy.jobs), CHUNK) if not _mark(policy, first).exists()]
    yield from Parallel(n_jobs=jobs, return_as="generator_unordered")(delayed(_chunk)(policy, m) for m in missing)


def prepare(domain: str, folder: Path, about: dict[str, Any], runs: Sequence[Any]) -> None:
    """Make a data set folder, with its manifest, for every action that has a duration model."""
    loaded = domains.load(domain)
    for action in actions(domain):
        manifest = {
            "robot": loaded.robot,
            "domain": domain,
            "action": action,
            "arguments": gathering.argument_ranges(loaded, action),
            "runs": len(runs),
            "source_sha256": gathering.source_hash(loaded.robot, domain),
            "on_policy": True,
            **about,
        }
        (folder / action).mkdir(parents=True, exist_ok=True)
        write_manifest(folder / action, manifest)


def actions(domain: str) -> list[str]:
    """Names of the data sets: the actions whose duration models the domain's actions name."""
    return sorted({action.duration_model.split("/")[0] for action in domains.load(domain).actions.values()})


def write(domain: str, folder: Path, part: str, cut: Sequence[tuple[str, Episode]]) -> None:
    """Write the episodes of some runs, each to its action's data set."""
    loaded = domains.load(domain)
    for action in actions(domain):
        mine = [episode for name, episode in cut if name == action]
        if mine:
            names = gathering.argument_names(loaded, action)
            write_part(folder / action / f"part-{part}.parquet", mine, names)


def cut_recordings(domain: str, folder: Path, recordings: Sequence[Path]) -> dict[str, int]:
    """Cut recordings into data sets; returns the number of episodes by action.

    Raises:
      UsageError: A file is no recording of an executive's run, or none holds a finished action.
    """
    prepare(domain, folder, {"source": "recordings", "recordings": [path.name for path in recordings]}, recordings)
    counts = dict.fromkeys(actions(domain), 0)
    number = 0
    for path in recordings:
        cut = Cutter(domains.load(domain)).read(_messages(path))
        numbered = [(action, replace(e, number=number + k)) for k, (action, e) in enumerate(cut)]
        write(domain, folder, f"{number:06d}", numbered)
        number += len(cut)
        for action, _ in cut:
            counts[action] += 1
    if not number:
        raise UsageError(f"{', '.join(map(str, recordings))}: no finished action, expected the recording of a run")
    return counts


def _messages(path: Path) -> Iterator[Message]:
    """What the cutter reads, in the order in which it was said."""
    from runtime.recording import open_recording
    from schemas.codec import decode
    from schemas.typesystem import type_of

    for recorded in sorted(open_recording(path).messages(), key=lambda m: m.publish_ns):
        kind = type_of(recorded.ros_type)
        if kind in READ:
            message = decode(kind, recorded.data)
            if isinstance(message, Rejected):
                raise UsageError(f"{path}: {recorded.key} number {recorded.sequence}: {message.reason}")
            yield message


def _mark(policy: Policy, first: int) -> Path:
    return policy.folder / f"runs-{first:06d}.done"


def _chunk(policy: Policy, first: int) -> int:
    some = policy.jobs[first : first + CHUNK]
    cut = []
    for k, (scenario, seed) in enumerate(some):
        base = MOST_ACTIONS * (first + k)
        cut += [(a, replace(e, number=base + i)) for i, (a, e) in enumerate(_run(policy, scenario, seed))]
    write(policy.domain, policy.folder, f"{first:06d}", cut)
    _mark(policy, first).touch()
    return len(some)


def _run(policy: Policy, scenario: str, seed: int) -> list[tuple[str, Episode]]:
    from tools.episodes import SENDER, run_episode

    domain = domains.load(policy.domain)
    drawn, start = domains.seeded_scenario(policy.domain, scenario, seed)
    settings = Settings(seed=seed, refinement=UNPROVEN)
    context = make_context(domain, drawn, _models(domain.robot, policy.zoo), settings, SENDER)
    return Cutter(domain).read(run_episode(context, lockstep.new_body(domain), start, seed).messages)


@lru_cache(maxsize=2)
def _models(robot: str, zoo: str) -> Models:
    """Loaded once a process."""
    return Models(*load_robot(robot, Path(zoo) if zoo else None))
