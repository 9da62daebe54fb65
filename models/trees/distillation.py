"""Distils what a model says into one model tree that prints as rules and costs a tenth of a bag."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tailor.models.trees.linear_tree import LinearTree
from tailor.models.trees.linear_variant import TreeSettings, fit_linear
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor

Floats = NDArray[np.float32]
Answers = tuple[NDArray[Any], NDArray[Any]]  # mean and spread, (n,) each

ROWS = 30_000  # asked of the teacher, at most
ROWS_EACH = 30  # for each row of the examples
SETTINGS = TreeSettings(max_leaves=64, min_rows=60, smoothing=0.0)


def between(features: Floats, count: int, rng: np.random.Generator) -> Floats:
    """Rows on the lines between random pairs of rows: everywhere that the examples surround, shape (count, f)."""
    a, b = features[rng.integers(0, len(features), (2, count))]
    share = rng.uniform(0, 1, (count, 1)).astype(np.float32)
    return a + share * (b - a)


def distil(teacher: Callable[[Floats], Answers], features: Floats) -> LinearTree:
    """A tree fitted to what the teacher says of features (n, f); a leaf's spread is the mean of the teacher's there."""
    mean, spread = teacher(features)
    nothing = np.zeros(len(mean), bool)
    tree = fit_linear(features, mean.astype(np.float64), np.ones(len(mean)), nothing, SETTINGS)
    leaf = tree.splits.leaf_of(features)
    rows = np.bincount(leaf, minlength=tree.leaves)
    uncertain = np.bincount(leaf, spread, tree.leaves) / np.maximum(rows, 1)
    return tree.with_std(uncertain.astype(np.float32))


class DistilledModelTree(ModelTreeRegressor):
    """One tree of 64 leaves that says what a bag says; its settings are the bag's."""

    def __init__(
        self,
        trees: int = 10,
        max_leaves: int = 64,
        min_rows: float = 40.0,
        smoothing: float = 0.0,
        ridge: float = 1e-4,
        bins: int = 64,
        clip: bool = True,
        random_state: int | np.random.Generator | None = 0,
    ) -> None:
        super().__init__("linear", 0.0, max_leaves, min_rows, smoothing, ridge, bins, clip, random_state)
        self.trees = trees

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit a bag to features (n, f) and seconds (n,), then one tree to the bag."""
        features, _, _ = self._checked(X, y, groups)
        settings = (self.max_leaves, self.min_rows, self.smoothing, self.ridge, self.bins, self.clip)
        bag = BaggedModelTrees(self.trees, *settings, self.random_state).fit(X, y, groups)
        asked = between(features, min(ROWS, ROWS_EACH * len(features)), np.random.default_rng(self.random_state or 0))
        self.tree_ = distil(bag.predict_with_std, np.concatenate([features, asked]))
        return self
