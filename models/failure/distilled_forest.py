"""Random forest distilled from gradient boosting, for rare failures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.tree import DecisionTreeRegressor

from tailor.models.episodes.episode_groups import bootstrap_weights
from tailor.models.failure.failure_model import FailureTrees, Floats, Ints
from tailor.models.fitted_trees.sklearn_trees import Step, means_of, splits_of

Array = NDArray[np.float64]

FEATURE_SHARE = 0.7  # of the features, considered for each split
MIN_ROWS = 5  # in a leaf
FOLDS = 5  # for the number of boosted trees
UNSURE = 1e-6  # what is left of a probability's certainty in a log loss
TEACHER = {"learning_rate": 0.05, "max_leaf_nodes": 16, "min_samples_leaf": 20, "early_stopping": False}


class DistilledForest(FailureTrees):
    """Regression trees over resampled episodes, fitted to the probabilities of boosted trees (Friedman 2001).

    An optimiser evaluates the model where failures are rare. There a forest fitted to outcomes, with both classes in
    each leaf, hardly separates 1 % from 10 %; boosting does. But boosting's sum of logits has no bounds leaf by leaf,
    which a mean of trees has.

    The teacher has as many trees as cross-validation over episodes finds best: with more it would learn a few failures
    by heart, and be too sure of all else.

    Args:
      trees: Number of trees.
      leaves: Maximum number of leaves per tree.
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      rounds: Maximum number of boosted trees of the teacher.
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

    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        rng = np.random.default_rng(self.random_state or 0)
        targets = self._teacher_probabilities(features, success, episodes, rng)
        min_rows = min(MIN_ROWS, max(1, len(targets) // 20))
        steps: list[Step] = []
        for _ in range(self.trees):
            weights = bootstrap_weights(episodes, rng)
            drawn = np.flatnonzero(weights)
            tree = DecisionTreeRegressor(
                max_leaf_nodes=self.leaves,
                min_samples_leaf=min_rows,
                max_features=FEATURE_SHARE,
                random_state=int(rng.integers(2**31)),
            ).fit(features[drawn], targets[drawn], weights[drawn])
            steps.append((splits_of(tree), means_of(tree)))
        return steps

    def _teacher_probabilities(
        self, features: Floats, success: Ints, episodes: Ints, rng: np.random.Generator
    ) -> Array:
        """Probability of success of each row by the boosted trees, shape (n,)."""
        if len(self.classes_) < 2:
            return np.ones(len(success))
        rounds = self._best_rounds(features, success, episodes, rng)
        return np.asarray(_boosted(features, success, rounds, rng).predict_proba(features)[:, 1])

    def _best_rounds(self, features: Floats, success: Ints, episodes: Ints, rng: np.random.Generator) -> int:
        """Number of boosted trees with the least log loss on episodes that they have not seen."""
        loss = np.zeros(self.rounds)
        fold = rng.permutation(int(episodes.max()) + 1)[episodes] % FOLDS
        for held in (fold == k for k in range(FOLDS)):
            if held.any() and len(np.unique(success[~held])) == 2:
                teacher = _boosted(features[~held], success[~held], self.rounds, rng)
                loss += [_log_loss(each, success[held]) for each in teacher.staged_predict_proba(features[held])]
        return int(loss.argmin()) + 1 if loss.any() else self.rounds


def _boosted(features: Floats, success: Ints, rounds: int, rng: np.random.Generator) -> HistGradientBoostingClassifier:
    seed = int(rng.integers(2**31))
    return HistGradientBoostingClassifier(max_iter=rounds, random_state=seed, **TEACHER).fit(features, success)


def _log_loss(probabilities: Array, success: Ints) -> float:
    """Summed over rows; probabilities of failure and success, shape (n, 2)."""
    of_outcome = probabilities[np.arange(len(success)), success]
    return -float(np.log(np.clip(of_outcome, UNSURE, 1.0)).sum())
