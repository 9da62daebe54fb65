"""Decision tree with calibrated probabilities of success, pessimistic by its cost ratio (paper 5.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import DecisionTreeClassifier

from tailor.models.episodes.episode_groups import held_out_rows
from tailor.models.failure.failure_model import FailureTrees, Floats, Ints
from tailor.models.fitted_trees.sklearn_trees import Step, splits_of
from tailor.models.fitted_trees.split_tree import SplitTree

Bools = NDArray[np.bool_]

PRIOR_ROWS = 10.0  # how many held-out rows the training share counts for
CANDIDATES = 25  # pruning strengths to compare


class FailureTree(FailureTrees):
    """A decision tree whose leaves hold calibrated probabilities of success.

    The tree is grown and pruned with failures weighted by the cost ratio. The probability of a leaf is the plain share
    of successes among the *held-out* episodes in it, shrunk towards the share in its training rows.

    Args:
      cost_ratio: Cost of a missed failure over that of a false alarm; WEKA's cost matrix in the paper.
      min_rows: Minimum number of rows in a leaf.
      held_out: Share of episodes that choose the pruning and calibrate the leaves, 0..1.
      random_state: Seed or generator that draws the held-out episodes.
    """

    def __init__(
        self,
        cost_ratio: float = 1.0,
        min_rows: int = 10,
        held_out: float = 0.25,
        random_state: int | np.random.Generator | None = 0,
    ) -> None:
        self.cost_ratio = cost_ratio
        self.min_rows = min_rows
        self.held_out = held_out
        self.random_state = random_state

    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        held = held_out_rows(episodes, self.held_out, self.random_state)
        splits = splits_of(self._pruned(features, success, held))
        return [(splits, _calibrated(splits, features, success, held))]

    def _pruned(self, features: Floats, success: Ints, held: Bools) -> DecisionTreeClassifier:
        """The tree with the lowest cost on held-out rows over all pruning strengths, grown on the other rows."""
        weights = np.where(success == 0, self.cost_ratio, 1.0)
        kept = ~held
        settings = {"min_samples_leaf": min(self.min_rows, max(1, int(kept.sum()) // 20)), "random_state": 0}
        path = DecisionTreeClassifier(**settings).cost_complexity_pruning_path(
            features[kept], success[kept], weights[kept]
        )
        alphas = np.unique(np.quantile(path.ccp_alphas.clip(0), np.linspace(0, 1, CANDIDATES), method="lower"))
        best, best_cost = None, np.inf
        for alpha in alphas:
            tree = DecisionTreeClassifier(**settings, ccp_alpha=alpha).fit(features[kept], success[kept], weights[kept])
            cost = float(weights[held][tree.predict(features[held]) != success[held]].sum()) if held.any() else alpha
            if cost <= best_cost:
                best, best_cost = tree, cost
        return best


def _calibrated(splits: SplitTree, features: Floats, success: Ints, held: Bools) -> Floats:
    """Probability of success in each leaf, shape (leaves,)."""
    leaf, size = splits.leaf_of(features), splits.leaves
    kept = np.bincount(leaf[~held], success[~held], size), np.bincount(leaf[~held], minlength=size)
    fresh = np.bincount(leaf[held], success[held], size), np.bincount(leaf[held], minlength=size)
    prior = (kept[0] + 0.5) / (kept[1] + 1)  # half a success and half a failure: no leaf is certain
    return ((fresh[0] + PRIOR_ROWS * prior) / (fresh[1] + PRIOR_ROWS)).astype(np.float32)
