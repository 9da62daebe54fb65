"""Base of the estimators of failure: scikit-learn classifiers of two classes, failure and success."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils import Tags
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from tailor.models.episodes.episode_groups import episode_indices
from tailor.models.fitted_trees.sklearn_trees import Step

Floats = NDArray[np.float32]
Ints = NDArray[np.int64]


class FailureModel(ClassifierMixin, BaseEstimator, ABC):  # type: ignore[misc]
    """Predicts success where its probability outweighs the cost of a missed failure.

    Attributes:
      cost_ratio: Cost of a missed failure over that of a false alarm; moves the threshold, not the probabilities.
      classes_: After `fit`, the sorted classes, shape (2,): failure before success.
    """

    cost_ratio: float
    classes_: NDArray[Any]

    @abstractmethod
    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to observed outcomes.

        Args:
          X: Features, shape (n, f).
          y: Outcomes, shape (n,): two classes that sort failure before success, as 0 and 1 do.
          groups: Episode of each row, shape (n,); None if every row is an episode of its own.
        """

    @abstractmethod
    def predict_proba(self, X: Any) -> NDArray[Any]:
        """Probabilities of failure and success, shape (n, 2), of features (n, f)."""

    @property
    def threshold_(self) -> float:
        """Probability of success, 0..1, from which success is predicted: there both mistakes cost the same."""
        return self.cost_ratio / (1 + self.cost_ratio)

    def predict(self, X: Any) -> NDArray[Any]:
        """Class with the lower expected cost, shape (n,), of features (n, f)."""
        success = self.predict_proba(X)[:, -1] >= self.threshold_
        chosen: NDArray[Any] = self.classes_[success.astype(np.int64) * (len(self.classes_) - 1)]
        return chosen


class FailureTrees(FailureModel):
    """Base of the trees and forests: the mean over trees with a probability of success in each leaf.

    Attributes:
      steps_: After `fit`, each tree with the probabilities of its leaves.
    """

    steps_: list[Step]

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to observed outcomes; see `FailureModel.fit`.

        Raises:
          ValueError: The rows are not finite numbers, or of more than two classes.
        """
        X, y = validate_data(self, X, y, dtype=np.float64)
        check_classification_targets(y)
        self.classes_, success = np.unique(y, return_inverse=True)
        if len(self.classes_) > 2:
            raise ValueError("Only binary classification is supported. The type of the target is multiclass.")
        self.steps_ = self._fitted(X.astype(np.float32), success, episode_indices(groups, len(y)))
        return self

    @abstractmethod
    def _fitted(self, features: Floats, success: Ints, episodes: Ints) -> list[Step]:
        """Trees fitted to features (n, f), successes 0 or 1 (n,) and episode numbers (n,)."""

    def predict_proba(self, X: Any) -> Floats:
        """Probabilities of failure and success, shape (n, 2), of features (n, f); one column if one class was seen."""
        check_is_fitted(self)
        features = np.asarray(validate_data(self, X, dtype=np.float64, reset=False), np.float32)
        each = [values[splits.leaf_of(features)] for splits, values in self.steps_]
        success = np.mean(each, axis=0, dtype=np.float32)
        both = np.stack([1 - success, success], axis=1)
        return both if len(self.classes_) == 2 else np.ones((len(both), 1), np.float32)

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags
