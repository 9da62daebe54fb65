"""Gathers random episodes whose success a model is least certain of (uncertainty sampling, Lewis and Gale 1994).

Where failures are rare, random episodes hold too few to learn from. So many tasks are drawn, without running them, and
those whose predicted probability of success is nearest to one half are run.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive import domains
from tailor.executive.interfaces.models import SuccessModel
from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.sources import CANDIDATES
from tailor.models.inference import OnnxSuccess
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.tools.learning.gathering import run_data_sets
from tailor.tools.learning.gathering.data_set_spec import UNCERTAIN_STREAM, DataSetSpec, argument_names, draw
from tailor.tools.learning.gathering.random_episodes import MAX_EPISODES, PART, check_action, run_one
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.parallel.pool import completed
from tailor.tools.parallel.steps import Step, counted

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Uncertain:
    """A data set of random episodes whose success is least certain.

    Attributes:
      domain: Name of the domain.
      action: An action with a model of success.
      episodes: Number of episodes.
      pool: Tasks that are drawn for each of them.
      seed: Of tasks and noise.
      zoo: Folder of the model; empty: those that ship.
      folder: Folder of the data set.
      profile: Of the body; empty: the one that ships.
    """

    domain: str
    action: str
    episodes: int
    pool: int
    seed: int
    zoo: str
    folder: Path
    profile: str = ""

    @property
    def candidates(self) -> int:
        """Number of tasks that are drawn."""
        return self.pool * self.episodes

    @property
    def spec(self) -> DataSetSpec:
        """How each task is drawn and run."""
        drawn = (self.domain, self.action, self.candidates, self.seed, self.folder)
        return DataSetSpec(*drawn, stream=UNCERTAIN_STREAM, profile=self.profile)


def run_uncertain(sets: Sequence[Uncertain], jobs: int, resume: bool = True) -> Iterator[Step]:
    """Check and prepare all folders; then, for each, select tasks, and run the missing episodes.

    Returns:
      Progress, while it is iterated over.

    Raises:
      UsageError: A folder holds other episodes, or the same ones without `resume`; or there are too many tasks, or an
        action has no model of success, or it fails its checks. Nothing is written then.
    """
    for each in sets:
        check_candidates(each.pool, each.episodes)
    models = [_model(each) for each in sets]
    manifests = {each.folder: _manifest(each, sha256) for each, (_, sha256) in zip(sets, models, strict=True)}
    run_data_sets.create(manifests, resume)
    return _run_sets(sets, [model for model, _ in models], jobs)


def _run_sets(sets: Sequence[Uncertain], models: Sequence[SuccessModel], jobs: int) -> Iterator[Step]:
    for each, model in zip(sets, models, strict=True):
        yield from _select_and_run(each, model, jobs)


def _manifest(uncertain: Uncertain, sha256: str) -> dict[str, Any]:
    """The manifest of a data set whose episodes a model of that hash selects."""
    about = {
        "source": "lock-step, random arguments whose success is least certain",
        "seed": uncertain.seed,
        CANDIDATES: uncertain.candidates,
        "episodes": uncertain.episodes,
        "on_policy": False,
        "models_sha256": sha256,
        **({"profile": uncertain.profile} if uncertain.profile else {}),
    }
    place = (uncertain.domain, uncertain.folder.parent, uncertain.action)
    return run_data_sets.manifest(*place, about, uncertain.episodes)


def check_candidates(pool: int, episodes: int) -> None:
    """Raise UsageError if so many tasks for each episode are too many."""
    if pool * episodes > MAX_EPISODES:
        raise UsageError(f"{pool * episodes} random tasks (episodes × pool), expected at most {MAX_EPISODES}")


def judged_actions(domain: str, requested: Sequence[str] = ()) -> list[str]:
    """The requested actions, or all with a model of success but for those that use another action's.

    Raises:
      UsageError: There is none, or the domain lacks a requested one, or it has none.
    """
    for action in requested:
        check_action(domain, action)
        success_model(domain, action)
    declared = domains.load(domain).actions.values()
    found = list(dict.fromkeys(requested)) or [a.name for a in declared if a.success_model.startswith(f"{a.name}/")]
    if not found:
        raise UsageError(f"no action of {domain} has a model of success, expected one to be uncertain of")
    return found


def success_model(domain: str, action: str) -> str:
    """Path of the model of an action's success in its robot's models.

    Raises:
      UsageError: It has none.
    """
    path = domains.load(domain).actions[action].success_model
    if not path:
        raise UsageError(f"action '{action}' of {domain} has no model of success, expected one")
    return path


def least_certain(probabilities: Array, count: int) -> list[int]:
    """Indices, ascending, of the `count` probabilities nearest to one half; the first ones of equal ones, no NaN."""
    ranked = np.argsort(np.abs(probabilities - 0.5), kind="stable")  # NaN last
    known = ranked[: np.count_nonzero(~np.isnan(probabilities))]
    return sorted(known[:count].tolist())


def _model(uncertain: Uncertain) -> tuple[SuccessModel, str]:
    """The action's model of success, and its hash."""
    robot, name = domains.load(uncertain.domain).robot, success_model(uncertain.domain, uncertain.action)
    loaded = load_model(f"{robot}/{name}", Path(uncertain.zoo) if uncertain.zoo else models_folder(robot))
    assert isinstance(loaded, OnnxSuccess)  # its name says so, which its card must match
    return loaded, loaded.card["sha256"]


def _select_and_run(uncertain: Uncertain, model: SuccessModel, jobs: int) -> Iterator[Step]:
    """The steps of `run_uncertain`; episodes in parallel."""
    spec, domain = uncertain.spec, domains.load(uncertain.domain)
    tasks = np.stack([draw(spec, domain, spec.rng(number)) for number in range(uncertain.candidates)])
    chosen = least_certain(model.probability(tasks), uncertain.episodes)
    parts = [first for first in range(0, len(chosen), PART) if not _part(uncertain, first).exists()]
    left = sum(len(chosen[first : first + PART]) for first in parts)
    ran = _run_all(uncertain, chosen, parts, jobs)
    yield from counted(f"{uncertain.action}: episodes of uncertain success", ran, len(chosen), len(chosen) - left)


def _part(uncertain: Uncertain, first: int) -> Path:
    return uncertain.folder / f"part-{first:06d}.parquet"


def _run_all(uncertain: Uncertain, chosen: Sequence[int], parts: Sequence[int], jobs: int) -> Iterator[int]:
    """Write the episodes of the missing parts; yields numbers of episodes."""
    names = argument_names(domains.load(uncertain.domain), uncertain.action)
    calls = [(uncertain.spec, chosen[first : first + PART]) for first in parts]
    for number, episodes in completed(_run, calls, jobs):
        write_part(_part(uncertain, parts[number]), episodes, names)
        yield len(episodes)


def _run(spec: DataSetSpec, numbers: Sequence[int]) -> list[Episode]:
    """Run some of the tasks."""
    domain, body = domains.load(spec.domain), body_of(spec.domain, spec.profile)
    return [run_one(spec, domain, body, number) for number in numbers]
