"""Queries of loaded models: random arguments in a card's ranges, and trees distilled from any model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import DecisionTreeRegressor

from tailor.models.cards.card import Card
from tailor.models.features.features import FeatureSpace
from tailor.models.features.spaces import feature_space
from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.fitted_trees.sklearn_trees import means_of, splits_of
from tailor.models.fitted_trees.split_tree import SplitTree
from tailor.models.inference import OnnxDuration, OnnxSuccess
from tailor.models.trees.distillation import distill

Array = NDArray[np.float64]
ROWS = 30_000


def space_of(card: Card) -> FeatureSpace:
    """Feature space of a card.

    Raises:
      UsageError: No installed package declares it.
    """
    return feature_space(card["features"])


def random_arguments(card: Card, count: int, rng: np.random.Generator) -> Array:
    """Arguments uniform over the card's ranges, shape (count, k)."""
    lower, upper = ([argument[key] for argument in card["arguments"]] for key in ("lower", "upper"))
    return rng.uniform(lower, upper, (count, len(lower)))


def distilled_duration(model: OnnxDuration, rng: np.random.Generator) -> tuple[LinearTree, float]:
    """A tree of at most 64 leaves distilled from a model, and the mean difference in seconds."""
    space = space_of(model.card)
    arguments, fresh = (random_arguments(model.card, rows, rng) for rows in (ROWS, ROWS // 10))
    tree = distill(lambda _: model.predict(arguments), space(arguments))
    return tree, float(np.nanmean(np.abs(tree.predict(space(fresh)) - model.predict(fresh)[0])))


def distilled_success(model: OnnxSuccess, rng: np.random.Generator) -> tuple[SplitTree, NDArray[np.float32], float]:
    """A tree of at most 24 leaves distilled from a model, its probabilities, and the mean difference."""
    space = space_of(model.card)
    arguments, fresh = (random_arguments(model.card, rows, rng) for rows in (ROWS, ROWS // 10))
    grown = DecisionTreeRegressor(max_leaf_nodes=24, min_samples_leaf=100, random_state=0)
    grown.fit(space(arguments), model.probability(arguments))
    splits, success = splits_of(grown), means_of(grown)
    off = np.abs(success[splits.leaf_of(space(fresh))] - model.probability(fresh))
    return splits, success, float(np.nanmean(off))
