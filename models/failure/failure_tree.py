"""The failure tree: a decision tree that predicts whether an action succeeds, pessimistic on purpose (paper 5.4)."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.tree import DecisionTreeClassifier
from sklearn.utils import Tags
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from tailor.models.episodes.episode_groups import held_out, numbered
from tailor.models.trees.sklearn_trees import Step, splits_of
from tailor.models.trees.split_tree import SplitTree

Ints = NDArray[np.int64]


class FailureModel(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """What failure models share: two classes (sorted: failure before success), and the cost of mistakes.

    A fitted model has `steps_`: trees with the probability of success in each leaf; it predicts their mean.
    """

    cost_ratio: float
    steps_: list[Step]

    def _checked(self, X: Any, y: Any, groups: Any) -> tuple[NDArray[np.float32], Ints, Ints]:
        X, y = validate_data(self, X, y, dtype=np.float64)
        check_classification_targets(y)
        self.classes_, success = np.unique(y, return_inverse=True)
        if len(self.classes_) > 2:
            raise ValueError("Only binary classification is supported. The type of the target is multiclass.")
        return X.astype(np.float32), success, numbered(groups, len(y))

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags

    def predict_proba(self, X: Any) -> NDArray[np.float32]:
        """Probabilities of failure and success, shape (n, 2); one column if training saw one class."""
        check_is_fitted(self)
        features = np.asarray(validate_data(self, X, dtype=np.float64, reset=False), np.float32)
        each = [values[splits.leaf_of(features)] for splits, values in self.steps_]
        success = np.mean(each, axis=0, dtype=np.float32)
        both = np.stack([1 - success, success], axis=1)
        return both if len(self.classes_) == 2 else np.ones((len(both), 1), np.float32)

    @property
    def threshold_(self) -> float:
        """Predict success only above this probability of it: where both mistakes cost the same."""
        return self.cost_ratio / (1 + self.cost_ratio)

    def predict(self, X: Any) -> NDArray[Any]:
        """The class with the lower expected cost, shape (n,)."""
        success = self.predict_proba(X)[:, -1] >= self.threshold_
        return self.classes_[success.astype(np.int64) * (len(self.classes_) - 1)]


class FailureTree(FailureModel):
    """A decision tree whose leaves hold calibrated probabilities of success.

    Grown and pruned with failures weighted by the cost ratio; what a leaf then says is the plain share of successes
    among the *held-out* episodes that fall into it, drawn towards the share in its training rows.

    Args:
      cost_ratio: Cost of a missed failure over that of a false alarm; WEKA's cost matrix in the paper.
      min_rows: Rows in a leaf at least.
      held_out: Share of episodes that choose the pruning and calibrate the leaves.
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

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,), two classes; `groups` (n,) says which rows are one episode."""
        features, success, episodes = self._checked(X, y, groups)
        held = held_out(episodes, self.held_out, self.random_state)
        splits = splits_of(self._pruned(features, success, held))
        self.steps_ = [(splits, _calibrated(splits, features, success, held))]
        return self

    def _pruned(
        self, features: NDArray[np.float32], success: NDArray[np.int64], held: NDArray[np.bool_]
    ) -> DecisionTreeClassifier:
        """The tree of the pruning strength with the least cost on held-out rows, grown on the others."""
        weights = np.where(success == 0, self.cost_ratio, 1.0)
        kept = ~held
        settings = {"min_samples_leaf": min(self.min_rows, max(1, int(kept.sum()) // 20)), "random_state": 0}
        path = DecisionTreeClassifier(**settings).cost_complexity_pruning_path(
            features[kept], success[kept], weights[kept]
        )
        alphas = np.unique(np.quantile(path.ccp_alphas.clip(0), np.linspace(0, 1, 25), method="lower"))
        best, best_cost = None, np.inf
        for alpha in alphas:
            tree = DecisionTreeClassifier(**settings, ccp_alpha=alpha).fit(features[kept], success[kept], weights[kept])
            cost = float(weights[held][tree.predict(features[held]) != success[held]].sum()) if held.any() else alpha
            if cost <= best_cost:
                best, best_cost = tree, cost
        return best


PRIOR_ROWS = 10.0  # how many held-out rows the training share counts for


def _calibrated(
    splits: SplitTree, features: NDArray[np.float32], success: NDArray[np.int64], held: NDArray[np.bool_]
) -> NDArray[np.float32]:
    leaf, size = splits.leaf_of(features), splits.leaves
    kept = np.bincount(leaf[~held], success[~held], size), np.bincount(leaf[~held], minlength=size)
    fresh = np.bincount(leaf[held], success[held], size), np.bincount(leaf[held], minlength=size)
    prior = (kept[0] + 0.5) / (kept[1] + 1)  # half a success and half a failure: no leaf is certain
    return ((fresh[0] + PRIOR_ROWS * prior) / (fresh[1] + PRIOR_ROWS)).astype(np.float32)
