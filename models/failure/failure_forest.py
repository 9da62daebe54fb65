"""The failure forest: decision trees over resampled episodes; surer than one tree, as quick to run."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.tree import DecisionTreeClassifier

from tailor.models.episodes.episode_groups import resampled
from tailor.models.failure.failure_tree import FailureModel
from tailor.models.trees.sklearn_trees import shares_of, splits_of


class FailureForest(FailureModel):
    """Decision trees over resampled episodes and random features (Breiman's forest); the mean share predicts.

    Args:
      trees: How many.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      min_rows: Rows in a leaf at least.
      feature_share: Of the features, as many are looked at for each split; fewer make the trees differ more.
      random_state: Seed or generator that draws episodes and features.
    """

    def __init__(
        self,
        trees: int = 32,
        cost_ratio: float = 1.0,
        min_rows: int = 8,
        feature_share: float = 0.7,
        random_state: int | np.random.Generator | None = 0,
    ) -> None:
        self.trees = trees
        self.cost_ratio = cost_ratio
        self.min_rows = min_rows
        self.feature_share = feature_share
        self.random_state = random_state

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,), two classes; `groups` (n,) says which rows are one episode."""
        features, success, episodes = self._checked(X, y, groups)
        rng = np.random.default_rng(self.random_state or 0)
        least = min(self.min_rows, max(1, len(success) // 20))
        self.steps_ = []
        for _ in range(self.trees):
            weights = resampled(episodes, rng)
            drawn = np.flatnonzero(weights)
            tree = DecisionTreeClassifier(
                min_samples_leaf=least, max_features=self.feature_share, random_state=int(rng.integers(2**31))
            ).fit(features[drawn], success[drawn], weights[drawn])
            self.steps_.append((splits_of(tree), shares_of(tree)))
        return self
