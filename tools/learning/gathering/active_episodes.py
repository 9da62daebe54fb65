"""Gathers episodes where the models disagree most, at the choices of the optimiser.

Situations are drawn from scenarios and refined with the current models, without running them. Of each action, the
choices with the largest predicted standard deviation are run alone, as random episodes are. A bag's deviation is the
disagreement of its members, so these are the choices of which the models know least.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.whole_files import write_whole
from tailor.tools.learning.gathering import data_set_spec
from tailor.tools.learning.gathering.choosing_models import prepare_chosen
from tailor.tools.learning.gathering.random_episodes import PART
from tailor.tools.learning.gathering.refined_choices import Choice, read_choices, refined_choices
from tailor.tools.learning.gathering.situations import situations
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.episode_extraction import data_set_of
from tailor.tools.parallel.pool import completed
from tailor.tools.parallel.steps import Step, counted

FIRST_SEED = 3_000_000_000  # of situations; disjoint from those of evaluations and of on-policy runs
ACTIVE_STREAM = 14  # first word of the seeds of the episodes; data_set_spec.py has the others
CHUNK = 10  # situations that are written together


@dataclass(frozen=True, slots=True)
class Active:
    """Data sets of choices with large disagreement, one per action.

    Attributes:
      domain: Name of the domain.
      scenarios: Scenarios from which situations are drawn, in turn.
      episodes: Largest number of episodes of each action.
      pool: Situations drawn for each episode; with 1 nearly every choice is run.
      seed: Of situations and noise.
      zoo: Folder of the models that choose.
      folder: Folder of the data sets.
      profile: Of the body; empty: the one that ships.
    """

    domain: str
    scenarios: tuple[str, ...]
    episodes: int
    pool: int
    seed: int
    zoo: str
    folder: Path
    profile: str = ""

    @property
    def situations(self) -> list[tuple[str, int]]:
        """Scenario and seed of each situation."""
        return situations(self.scenarios, FIRST_SEED, self.seed, self.pool * self.episodes)


def run_active(active: Active, jobs: int, resume: bool = True) -> Iterator[Step]:
    """Check and prepare the folders; then draw and refine the missing situations, and run the missing episodes.

    Returns:
      Progress, while it is iterated over.

    Raises:
      UsageError: The folder holds other episodes, or the same ones without `resume`; or models fail their checks.
    """
    about: dict[str, Any] = {
        "source": "lock-step, choices with the largest disagreement",
        "situations": len(active.situations),
        "on_policy": False,  # they are selected, so they do not tell how often an optimiser's choices are wrong
        "episodes": active.episodes,
    }
    prepare_chosen(active, about, active.situations, resume)
    return _refine_and_run(active, jobs)


def _refine_and_run(active: Active, jobs: int) -> Iterator[Step]:
    """The steps of `run_active`, in parallel."""
    total = len(active.situations)
    missing = [first for first in range(0, total, CHUNK) if not _pool_path(active, first).exists()]
    left = sum(min(CHUNK, total - first) for first in missing)
    yield from counted("situations refined", _refine_all(active, missing, jobs), total, total - left)
    for name, choices in selected(_pool(active), active.episodes).items():
        parts = [first for first in range(0, len(choices), PART) if not _part(active, name, first).exists()]
        ran = _run_all(active, name, choices, parts, jobs)
        left = sum(min(PART, len(choices) - first) for first in parts)
        yield from counted(f"{name}: choices that models disagree on", ran, len(choices), len(choices) - left)


def selected(pool: Sequence[Choice], most: int) -> dict[str, list[Choice]]:
    """The choices of each data set with the largest disagreement, largest first, at most so many."""
    useful = [choice for choice in pool if np.isfinite(choice.std_s)]
    ranked = sorted(useful, key=lambda choice: -choice.std_s)
    names = sorted({choice.data_set for choice in useful})
    return {name: [choice for choice in ranked if choice.data_set == name][:most] for name in names}


def _refine_all(active: Active, missing: Sequence[int], jobs: int) -> Iterator[int]:
    """Write the choices of the missing situations; yields numbers of situations."""
    for number, rows in completed(_refine, [(active, first) for first in missing], jobs):
        path = _pool_path(active, missing[number])
        write_whole(path, json.dumps([[c.data_set, c.action, c.arguments, c.std_s] for c in rows]).encode())
        yield len(_some(active, missing[number]))


def _refine(active: Active, first: int) -> list[Choice]:
    """The choices of some situations."""
    body = body_of(active.domain, active.profile)
    return [
        choice
        for scenario, seed in _some(active, first)
        for choice in refined_choices(active.domain, scenario, seed, active.zoo, body)
    ]


def _some(active: Active, first: int) -> list[tuple[str, int]]:
    return active.situations[first : first + CHUNK]


def _pool_path(active: Active, first: int) -> Path:
    return active.folder / f"pool-{first:06d}-{min(first + CHUNK, len(active.situations)):06d}.json"


def _pool(active: Active) -> list[Choice]:
    paths = [_pool_path(active, first) for first in range(0, len(active.situations), CHUNK)]
    widths = {
        (data_set_of(action), name): len(action.parameters)
        for name, action in domains.load(active.domain).actions.items()
    }
    return [choice for path in paths for choice in read_choices(path, widths)]


def _part(active: Active, data_set: str, first: int) -> Path:
    return active.folder / data_set / f"part-{first:06d}.parquet"


def _run_all(
    active: Active, data_set: str, choices: Sequence[Choice], missing: Sequence[int], jobs: int
) -> Iterator[int]:
    """Write the episodes of the missing parts; yields numbers of episodes."""
    names = data_set_spec.argument_names(domains.load(active.domain), data_set)
    calls = [(active, data_set, first, choices[first : first + PART]) for first in missing]
    for number, episodes in completed(_run, calls, jobs):
        write_part(_part(active, data_set, missing[number]), episodes, names)
        yield len(episodes)


def _run(active: Active, data_set: str, first: int, choices: Sequence[Choice]) -> list[Episode]:
    """Run some choices, each from the state in which its action begins."""
    domain = domains.load(active.domain)
    body = body_of(active.domain, active.profile)
    episodes = []
    for number, choice in enumerate(choices, first):
        rng = np.random.default_rng([ACTIVE_STREAM, active.seed, zlib.crc32(data_set.encode()), number])
        arguments = np.array(choice.arguments)
        run = action_run.run_action(body, domain, choice.action, arguments, rng)
        episodes.append(
            Episode(number, arguments, run.ticks, run.duration_s, run.success, run.failure, run.done, run.work_j)
        )
    return episodes
