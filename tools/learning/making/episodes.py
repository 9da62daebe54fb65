"""Gathers the episodes of a recipe: random ones, those of uncertain success, then rounds and calibration."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tailor.tools.learning.gathering import policy_runs, random_episodes, run_data_sets
from tailor.tools.learning.gathering.active_episodes import Active, run_active
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.uncertain_episodes import Uncertain, run_uncertain
from tailor.tools.learning.making.making import Making
from tailor.tools.learning.making.recipe_checks import learned_beside
from tailor.tools.learning.recipe import MAX_SEED, Round
from tailor.tools.parallel.steps import Step, counted


def gather_random(making: Making) -> Iterator[Step]:
    """Gather the random episodes that are missing; yields progress."""
    recipe = making.recipe
    for action, count, folder, beside in _random_sets(making):
        objects = recipe.objects if beside else 0
        # of one seed, the tasks beside an object are those without; durations are learned and tested on both
        seed = recipe.seed + (MAX_SEED + 1 if beside and not objects else 0)  # no other recipe's
        drawn = (making.domain, action, count, seed, folder / action)
        spec = DataSetSpec(*drawn, beside=beside, objects=objects, profile=recipe.profile)
        random_episodes.prepare(spec, resume=True)
        missing = random_episodes.missing_parts(spec)
        left = sum(min(random_episodes.PART, count - first) for first in missing)
        running = (done for done, *_ in random_episodes.gather(spec, missing, making.jobs))
        title = f"{action}: random episodes" + (" beside an object" if beside else "")
        yield from counted(title, running, count, count - left)


def gather_uncertain(making: Making, zoo: Path) -> Iterator[Step]:
    """Gather the random episodes of whose success the models in a zoo are least certain; yields progress."""
    recipe, models = making.recipe, (making.recipe.seed, str(zoo))
    drawn = [((each.action, each.episodes, each.pool), making.uncertain / each.action) for each in recipe.uncertain]
    sets = [Uncertain(making.domain, *what, *models, folder, recipe.profile) for what, folder in drawn]
    yield from run_uncertain(sets, making.jobs)


def gather_round(making: Making, number: int, each: Round, zoo: Path) -> Iterator[Step]:
    """Gather round `number`, from 0, of episodes that the models in a zoo choose; yields progress."""
    seed, title = making.recipe.seed + number, f"round {number + 1}"
    where = (seed, str(zoo), making.round(number), making.recipe.profile)
    if each.source == "active":
        active = Active(making.domain, each.scenarios, each.episodes, each.pool, *where)
        for step in run_active(active, making.jobs):
            yield Step(f"{title}: {step.title}", step.done, step.total)
        return
    policy = policy_runs.Policy(making.domain, each.scenarios, each.episodes, *where, horizon=each.horizon)
    yield from _run(policy, title, making.jobs)


def gather_calibration(making: Making, zoo: Path) -> Iterator[Step]:
    """Gather the runs that correct the intervals of the models in a zoo; yields progress."""
    recipe, before = making.recipe, len(making.recipe.rounds)
    for number, (each, folder) in enumerate(zip(recipe.calibration, making.calibration, strict=True)):
        where = (recipe.seed + before + number, str(zoo), folder, recipe.profile)
        policy = policy_runs.Policy(making.domain, each.scenarios, each.episodes, *where, calibrates=True)
        yield from _run(policy, f"calibration {number + 1}", making.jobs)


def _run(policy: policy_runs.Policy, title: str, jobs: int) -> Iterator[Step]:
    running, done = policy_runs.run_policy(policy, jobs), policy_runs.finished_runs(policy)
    yield from counted(f"{title}: runs of {', '.join(policy.scenarios)}", running, len(policy.jobs), done)


def _random_sets(making: Making) -> list[tuple[str, int, Path, bool]]:
    """Data sets of random episodes: action, number, folder, and whether each is beside an object."""
    recipe, actions = making.recipe, run_data_sets.modelled_actions(making.domain)
    wanted = [(action, recipe.episodes_of(action), making.random, False) for action in actions]
    if recipe.beside:
        wanted += [(action, recipe.beside, making.beside, True) for action in learned_beside(making.domain)]
    return wanted
