"""Checks of a recipe against its robot, before anything is gathered: hours later, the same error would cost them."""

from __future__ import annotations

import numpy as np

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import random_episodes, run_data_sets
from tailor.tools.learning.gathering.beside_objects import check_sampler
from tailor.tools.learning.gathering.uncertain_episodes import check_candidates, success_model
from tailor.tools.learning.recipe import Recipe
from tailor.tools.lockstep.bodies import check_profile


def learned_beside(domain: str) -> list[str]:
    """Actions of a domain that need a model of their own success beside an object."""
    declared = domains.load(domain).actions
    contexts = {action: declared[action].context for action in run_data_sets.modelled_actions(domain)}
    return [name for name, context in contexts.items() if context and context.success_model.startswith(f"{name}/")]


def check_recipe(robot: str, recipe: Recipe) -> None:
    """Check a recipe: names of the profile, actions and scenarios, numbers, and that rounds can choose.

    Raises:
      UsageError: Too many episodes; the robot has none of a name, or a sampler that draws no objects where some are
        wanted; or the recipe gathers beside objects where no model of success is learned beside them, or has rounds,
        and gathers nothing there, where the executive chooses by such models.
    """
    domain = random_episodes.domain_of(robot)
    check_profile(domain, recipe.profile)
    actions = run_data_sets.modelled_actions(domain)
    for count in (recipe.episodes, *(each.episodes for each in recipe.random)):
        random_episodes.check_number(count)
    random_episodes.check_number(recipe.beside, recipe.objects)
    named = [("random episodes", each.action) for each in recipe.random]
    named += [("uncertain episodes", each.action) for each in recipe.uncertain]
    named += [("a learner", each.action) for each in recipe.training.learners]
    for what, action in named:
        if action not in actions:
            raise UsageError(f"{what} of '{action}', expected one of: {', '.join(actions)}")
    for each in recipe.uncertain:
        check_candidates(each.pool, each.episodes)
        success_model(domain, each.action)  # raises UsageError if there is none
    for each_round in recipe.rounds:
        RefinementSettings(horizon=each_round.horizon)  # raises UsageError if it is too long
    for scenario in dict.fromkeys(name for _, each in recipe.chosen for name in each.scenarios):
        domains.load_scenario(domain, scenario, np.random.default_rng(0))  # raises UsageError if there is none
    needed = learned_beside(domain)
    if recipe.beside and not needed:
        raise UsageError(f"beside is {recipe.beside}, expected 0: no action has a model of success beside an object")
    if recipe.beside:
        check_sampler(domains.load(domain), recipe.objects)
    if needed and recipe.chosen and not recipe.beside:
        raise UsageError(f"beside is 0, expected runs of {', '.join(needed)} beside objects, as rounds need")
