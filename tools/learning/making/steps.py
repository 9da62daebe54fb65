"""Makes the models of a robot from seeds: random episodes, then rounds that the models trained so far choose,
and at last runs by the models of all of them, which correct their intervals.

Equal source, libraries, recipe and platform give equal models, bit for bit. Every step is resumed where it stopped.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tailor.executive import domains
from tailor.tools.learning.gathering import data_set_spec, run_data_sets
from tailor.tools.learning.making.episodes import gather_calibration, gather_random, gather_round, gather_uncertain
from tailor.tools.learning.making.installing import check_complete
from tailor.tools.learning.making.making import CHOOSING, Making
from tailor.tools.learning.making.recipe_checks import check_recipe
from tailor.tools.learning.making.training import of_action, train_all, training_request
from tailor.tools.learning.training_request import spaces_by_kind
from tailor.tools.learning.training_run import checked
from tailor.tools.parallel.steps import Step


def check(making: Making) -> None:
    """Check all names in the recipe, before anything is gathered.

    Raises:
      UsageError: An unknown scenario, action, profile, learner or feature space, or one that does not fit the actions.
    """
    check_recipe(making.robot, making.recipe)
    request, domain = checked(training_request(making, making.zoo)), domains.load(making.domain)
    for action in run_data_sets.modelled_actions(making.domain):
        own = checked(of_action(making, request, action))
        spaces_by_kind(own, tuple(data_set_spec.argument_names(domain, action)), Path(action))


def make(making: Making) -> Iterator[Step]:
    """Gather and train all that is missing; yields progress. The models are in `making.zoo` at the end.

    Raises:
      UsageError: See `check`; or too few episodes, or a model that an action names and that could not be learned.
    """
    check(making)
    yield from gather_random(making)
    if making.recipe.uncertain:
        zoo = making.rounds / "zoo-uncertain"
        yield from train_all(making, zoo, [making.random], ("success",))
        yield from gather_uncertain(making, zoo)
    rounds = making.recipe.rounds
    for number, each in enumerate(rounds):
        zoo = making.chooser(number)
        yield from train_all(making, zoo, making.data(number), CHOOSING)
        yield from gather_round(making, number, each, zoo)
    if making.recipe.calibration:
        zoo = making.chooser(len(rounds))
        yield from train_all(making, zoo, making.data(len(rounds)), CHOOSING)
        yield from gather_calibration(making, zoo)
    data = [*making.data(len(rounds)), *making.calibration]
    yield from train_all(making, making.zoo, data, making.kinds or making.recipe.training.kinds)
    check_complete(making)
