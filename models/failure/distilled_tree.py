"""Single tree distilled from a failure forest: a hundredth of its cost, and printable as rules."""

from __future__ import annotations

import numpy as np
from sklearn.tree import DecisionTreeRegressor

from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_model import FailureTrees, Floats, Ints
from tailor.models.fitted_trees.sklearn_trees import Step, means_of, splits_of
from tailor.models.trees.distillation import interpolated_rows

MAX_ROWS = 40_000  # of interpolated features
ROWS_PER_EXAMPLE = 40  # of interpolated features
MIN_ROWS = 40  # in a leaf


class DistilledFailureTree(FailureTrees):
    """One tree of probabilities fitted to the predictions of a forest.

    Args:
      leaves: Maximum number of leaves.
      trees: Number of trees of the forest.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      min_rows: Minimum number of rows in a leaf of the forest.
      random_state: Seed or generator.
    """

    def __init__(
        self,
        leaves: int = 64,
        trees: int = 100,
        cost_ratio: float = 1.0,
        min_rows: int = 10,
        random_state: int | np.random.Generator | None = 0,
    ) -> None:
        self.leaves = leaves
        self.trees = trees
        self.cost_ratio = cost_ratio
        self.min_rows = min_rows
        self.random_state = random_state

    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        rng = np.random.default_rng(self.random_state or 0)
        forest = FailureForest(self.trees, self.cost_ratio, self.min_rows, random_state=rng)
        forest.fit(features, success, episodes)
        count = min(MAX_ROWS, ROWS_PER_EXAMPLE * len(features))
        rows = np.concatenate([features, interpolated_rows(features, count, rng)])
        tree = DecisionTreeRegressor(max_leaf_nodes=self.leaves, min_samples_leaf=MIN_ROWS, random_state=0)
        tree.fit(rows, forest.predict_proba(rows)[:, -1])
        return [(splits_of(tree), means_of(tree))]
