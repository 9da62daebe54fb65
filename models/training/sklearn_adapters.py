"""Adapters that give scikit-learn's estimators our interface: boosting, networks, support vectors (paper 8)."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from threadpoolctl import threadpool_limits

from tailor.models.failure.failure_model import FailureModel
from tailor.models.trees.regression_model import RegressionModel

Array = NDArray[np.float64]


class SklearnRegressor(RegressionModel):
    """Any regressor as a duration model; its standard deviation is that of its training errors, the same everywhere.

    Args:
      inner: The regressor.
    """

    def __init__(self, inner: Any) -> None:
        self.inner = inner

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); groups are ignored."""
        self.inner_ = clone(self.inner).fit(X, y)
        self.low_, self.high_ = float(np.min(y)), float(np.max(y))
        self.std_ = float(np.std(self.predict(X) - y))
        return self

    def predict(self, X: Any) -> Array:
        """Seconds, shape (n,), clipped to the range of the training targets."""
        return np.asarray(np.clip(self.inner_.predict(X), self.low_, self.high_))

    def predict_with_std(self, X: Any) -> tuple[Array, Array]:
        """Seconds and the constant standard deviation, shapes (n,)."""
        return self.predict(X), np.full(len(X), self.std_)


class SklearnClassifier(FailureModel):
    """Any probabilistic classifier of two classes as a failure model.

    Args:
      inner: The classifier.
      cost_ratio: Cost of a missed failure over that of a false alarm.
    """

    def __init__(self, inner: Any, cost_ratio: float = 1.0) -> None:
        self.inner = inner
        self.cost_ratio = cost_ratio

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,); groups are ignored."""
        with threadpool_limits(1):  # networks: several threads may sum in another order
            self.inner_ = clone(self.inner).fit(X, y)
        self.classes_ = self.inner_.classes_
        return self

    def predict_proba(self, X: Any) -> Array:
        """Probabilities of failure and success, shape (n, 2)."""
        return np.asarray(self.inner_.predict_proba(X))
