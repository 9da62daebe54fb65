"""Trains the models of a recipe on the episodes of all its steps so far."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tailor.models.cards.card import KINDS
from tailor.models.episodes.manifest import MANIFEST
from tailor.schemas.errors import UsageError
from tailor.tools.learning.making.making import Making
from tailor.tools.learning.recipe import OwnLearner
from tailor.tools.learning.training_request import (
    DEFAULT_CLEARANCE_LEARNER,
    DEFAULT_FAILURE_LEARNER,
    DEFAULT_LEARNER,
    TrainingRequest,
    data_sets,
)
from tailor.tools.learning.training_run import train_models
from tailor.tools.parallel.pool import Processes
from tailor.tools.parallel.steps import Step

WHOLE = "whole"  # marker of a folder of models, written last


def train_all(making: Making, zoo: Path, data: list[Path], kinds: tuple[str, ...]) -> Iterator[Step]:
    """Train into a zoo as `tailor train` does, unless that has been done; yields progress."""
    title, total = f"training {zoo.name}", 1
    if not (zoo / WHOLE).exists():
        near = [making.beside] if making.recipe.beside else []
        present = tuple(folder for folder in (*data, *near) if any(folder.glob(f"*/{MANIFEST}")))
        if not present:
            raise UsageError(f"{making.work}: no episodes to train on")
        for done, total in _train(making, training_request(making, zoo, present, kinds)):
            yield Step(title, done, total)
        (zoo / WHOLE).touch()
    yield Step(title, total, total)


def _train(making: Making, request: TrainingRequest) -> Iterator[tuple[int, int]]:
    """Train each model in a process of its own, equal bits for any number of jobs; yields how many of them are done."""
    each = [
        dataclasses.replace(of_action(making, request, action), actions=(action,), kinds=(kind,))
        for kind in request.kinds or KINDS
        for action in data_sets(request)
    ]
    yield 0, len(each)
    for done, _ in enumerate(Processes().completed(train_models, [(one,) for one in each], making.jobs), 1):
        yield done, len(each)


def of_action(making: Making, request: TrainingRequest, action: str) -> TrainingRequest:
    """The request with the learner and the feature space that the recipe names for an action."""
    own = next((each for each in making.recipe.training.learners if each.action == action), OwnLearner(action))
    return dataclasses.replace(
        request, learner=own.learner or request.learner, features=own.features or request.features
    )


def training_request(
    making: Making, zoo: Path, data: tuple[Path, ...] = (), kinds: tuple[str, ...] = ()
) -> TrainingRequest:
    """What a recipe asks of the training: learners, feature spaces, seed."""
    options = making.recipe.training
    named: dict[str, Any] = {
        "features": options.features or None,
        "energy_features": options.energy_features or None,
        "learner": options.learner or DEFAULT_LEARNER,
        "failure_learner": options.failure_learner or DEFAULT_FAILURE_LEARNER,
        "clearance_learner": options.clearance_learner or DEFAULT_CLEARANCE_LEARNER,
    }
    return TrainingRequest(
        making.robot, zoo, data=data, seed=options.seed, command=making.command, kinds=kinds, **named
    )
