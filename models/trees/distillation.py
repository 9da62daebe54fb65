"""Distils the predictions of a model into one model tree, which prints as rules and costs a tenth of a bag."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.trees.linear_variant import TreeSettings, fit_linear
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor

Floats = NDArray[np.float32]
Predictions = tuple[NDArray[Any], NDArray[Any]]  # mean and standard deviation, (n,) each

MAX_ROWS = 30_000  # of interpolated features
ROWS_PER_EXAMPLE = 30  # of interpolated features
SETTINGS = TreeSettings(max_leaves=64, min_rows=60, smoothing=0.0)


def interpolated_rows(features: Floats, count: int, rng: np.random.Generator) -> Floats:
    """Points on the lines between random pairs of rows (n, f), shape (count, f)."""
    a, b = features[rng.integers(0, len(features), (2, count))]
    share = rng.uniform(0, 1, (count, 1)).astype(np.float32)
    rows: Floats = a + share * (b - a)
    return rows


def distill(teacher: Callable[[Floats], Predictions], features: Floats) -> LinearTree:
    """Fit a tree to a teacher's predictions.

    Args:
      teacher: Mean and standard deviation, shapes (n,), of features (n, f).
      features: Rows to fit to, shape (n, f).

    Returns:
      A tree of at most 64 leaves; a leaf's standard deviation is the teacher's mean standard deviation there.
    """
    mean, std = teacher(features)
    none = np.zeros(len(mean), bool)
    tree = fit_linear(features, mean.astype(np.float64), np.ones(len(mean)), none, SETTINGS)
    leaf = tree.splits.leaf_of(features)
    rows = np.bincount(leaf, minlength=tree.leaves)
    mean_std = np.bincount(leaf, std, tree.leaves) / np.maximum(rows, 1)
    return tree.with_std(mean_std.astype(np.float32))


class DistilledModelTree(ModelTreeRegressor):
    """One tree of at most 64 leaves that is fitted to a bag's predictions; the settings are the bag's."""

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
        count = min(MAX_ROWS, ROWS_PER_EXAMPLE * len(features))
        rows = interpolated_rows(features, count, np.random.default_rng(self.random_state or 0))
        self.tree_ = distill(bag.predict_with_std, np.concatenate([features, rows]))
        return self
