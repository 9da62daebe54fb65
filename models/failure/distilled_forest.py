"""A forest taught by boosted trees: as sure as they are where failures are rare, and bounded leaf by leaf."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.tree import DecisionTreeRegressor

from tailor.models.episodes.episode_groups import resampled
from tailor.models.failure.failure_tree import FailureModel
from tailor.models.trees.sklearn_trees import means_of, splits_of

Array = NDArray[np.float64]

FEATURE_SHARE = 0.7  # of the features, as many are looked at for each split
TEACHER = {"learning_rate": 0.05, "max_leaf_nodes": 16, "min_samples_leaf": 20, "early_stopping": False}


class DistilledForest(FailureModel):
    """Regression trees over resampled episodes that learn what boosted trees (Friedman 2001) say of each row.

    An optimiser asks where hardly anything fails, and there a forest of outcomes, with both kinds in each leaf, can
    hardly tell 1 % from 10 %; boosting can. But its sum of logits has no bounds leaf by leaf, as a mean of trees has.

    Args:
      trees: How many.
      leaves: Of each, at most.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      rounds: Boosted trees of the teacher.
      random_state: Seed or generator that draws episodes and features.
    """

    def __init__(
        self,
        trees: int = 16,
        leaves: int = 240,
        cost_ratio: float = 1.0,
        rounds: int = 300,
        random_state: int | np.random.Generator | None = 0,
    ) -> None:
        self.trees = trees
        self.leaves = leaves
        self.cost_ratio = cost_ratio
        self.rounds = rounds
        self.random_state = random_state

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,), two classes; `groups` (n,) says which rows are one episode."""
        features, success, episodes = self._checked(X, y, groups)
        rng = np.random.default_rng(self.random_state or 0)
        said = self._taught(features, success, rng)
        least = min(5, max(1, len(said) // 20))
        self.steps_ = []
        for _ in range(self.trees):
            weights = resampled(episodes, rng)
            drawn = np.flatnonzero(weights)
            tree = DecisionTreeRegressor(
                max_leaf_nodes=self.leaves,
                min_samples_leaf=least,
                max_features=FEATURE_SHARE,
                random_state=int(rng.integers(2**31)),
            ).fit(features[drawn], said[drawn], weights[drawn])
            self.steps_.append((splits_of(tree), means_of(tree)))
        return self

    def _taught(self, features: NDArray[np.float32], success: Any, rng: np.random.Generator) -> Array:
        """The probability of success of each row, shape (n,), as the teacher sees it."""
        if len(self.classes_) < 2:
            return np.ones(len(success))
        teacher = HistGradientBoostingClassifier(
            max_iter=self.rounds, random_state=int(rng.integers(2**31)), **TEACHER
        ).fit(features, success)
        return np.asarray(teacher.predict_proba(features)[:, 1])
