"""Asks loaded models: random arguments in a card's ranges, and a distilled tree of what any model says."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.card import Card
from models.distilling import distil
from models.features import SPACES, FeatureSpace
from models.linear_tree import LinearTree
from models.runtime import OnnxDuration, OnnxSuccess

Array = NDArray[np.float64]
ROWS = 30_000


def space_of(card: Card) -> FeatureSpace:
    """The feature space that a card names."""
    return SPACES[card["features"]]


def random_arguments(card: Card, count: int, rng: np.random.Generator) -> Array:
    """Arguments uniform over the card's ranges, shape (count, k)."""
    lower, upper = ([argument[key] for argument in card["arguments"]] for key in ("lower", "upper"))
    return rng.uniform(lower, upper, (count, len(lower)))


def distilled(model: OnnxDuration | OnnxSuccess, rng: np.random.Generator) -> tuple[LinearTree, float]:
    """A tree of at most 64 leaves that says what the model says, and by how much it differs on fresh arguments.

    For a success model the "seconds" of the tree are probabilities.
    """
    arguments = random_arguments(model.card, ROWS, rng)
    features = space_of(model.card)(arguments)
    tree = distil(lambda _: _answers(model, arguments), features)
    fresh = random_arguments(model.card, ROWS // 10, rng)
    off = np.abs(tree.predict(space_of(model.card)(fresh)) - _answers(model, fresh)[0])
    return tree, float(np.nanmean(off))


def _answers(model: OnnxDuration | OnnxSuccess, arguments: Array) -> tuple[NDArray[Any], NDArray[Any]]:
    if isinstance(model, OnnxDuration):
        return model.predict(arguments)
    probability = model.probability(arguments)
    return probability, np.sqrt(probability * (1 - probability))
