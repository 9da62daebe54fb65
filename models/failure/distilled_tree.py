"""A forest's judgement in one small tree: nearly as sure, a hundredth of the cost, and it prints as rules."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.tree import DecisionTreeRegressor

from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_tree import FailureModel
from tailor.models.trees.distillation import between
from tailor.models.trees.sklearn_trees import means_of, splits_of

ROWS = 40_000  # asked of the forest, at most
ROWS_EACH = 40  # for each row of the examples
MIN_ROWS = 40  # in a leaf


class DistilledFailureTree(FailureModel):
    """One tree of probabilities fitted to what a forest says.

    Args:
      leaves: At most.
      trees: Of the forest.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      min_rows: Rows in a leaf of the forest.
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

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit a forest to features (n, f) and outcomes (n,), two classes, then one tree to the forest."""
        features, _, _ = self._checked(X, y, groups)
        rng = np.random.default_rng(self.random_state or 0)
        forest = FailureForest(self.trees, self.cost_ratio, self.min_rows, random_state=rng).fit(X, y, groups)
        asked = np.concatenate([features, between(features, min(ROWS, ROWS_EACH * len(features)), rng)])
        said = forest.predict_proba(asked)[:, -1]
        grown = DecisionTreeRegressor(max_leaf_nodes=self.leaves, min_samples_leaf=MIN_ROWS, random_state=0)
        grown.fit(asked, said)
        self.steps_ = [(splits_of(grown), means_of(grown))]
        return self
