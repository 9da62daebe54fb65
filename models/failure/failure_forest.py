"""Random forest of decision trees over resampled episodes."""

from __future__ import annotations

import numpy as np
from sklearn.tree import DecisionTreeClassifier

from tailor.models.episodes.episode_groups import bootstrap_weights
from tailor.models.failure.failure_model import FailureTrees, Floats, Ints
from tailor.models.fitted_trees.sklearn_trees import Step, shares_of, splits_of


class FailureForest(FailureTrees):
    """Decision trees over resampled episodes and random features (Breiman 2001); the mean share predicts.

    Args:
      trees: Number of trees.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      min_rows: Minimum number of rows in a leaf.
      feature_share: Share of the features considered for each split, 0..1; fewer decorrelate the trees.
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

    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        rng = np.random.default_rng(self.random_state or 0)
        min_rows = min(self.min_rows, max(1, len(success) // 20))
        steps: list[Step] = []
        for _ in range(self.trees):
            weights = bootstrap_weights(episodes, rng)
            drawn = np.flatnonzero(weights)
            tree = DecisionTreeClassifier(
                min_samples_leaf=min_rows, max_features=self.feature_share, random_state=int(rng.integers(2**31))
            ).fit(features[drawn], success[drawn], weights[drawn])
            steps.append((splits_of(tree), shares_of(tree)))
        return steps
