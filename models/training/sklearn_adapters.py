"""Learners of scikit-learn behind our interface: boosting, networks, support vectors (paper 8)."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin, RegressorMixin, clone

Array = NDArray[np.float64]


class SklearnRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Any regressor as a duration model; its spread is the deviation of its training errors, everywhere alike.

    Args:
      inner: The regressor.
    """

    def __init__(self, inner: Any) -> None:
        self.inner = inner

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); episodes play no part."""
        self.inner_ = clone(self.inner).fit(X, y)
        self.low_, self.high_ = float(np.min(y)), float(np.max(y))
        self.spread_ = float(np.std(self.predict(X) - y))
        return self

    def predict(self, X: Any) -> Array:
        """Seconds, shape (n,), within what training saw."""
        return np.clip(self.inner_.predict(X), self.low_, self.high_)

    def predict_with_std(self, X: Any) -> tuple[Array, Array]:
        """Seconds and the constant spread, shapes (n,)."""
        return self.predict(X), np.full(len(X), self.spread_)


class SklearnClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """Any probabilistic classifier of two classes as a failure model.

    Args:
      inner: The classifier.
      cost_ratio: Cost of a missed failure over that of a false alarm.
    """

    def __init__(self, inner: Any, cost_ratio: float = 1.0) -> None:
        self.inner = inner
        self.cost_ratio = cost_ratio

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,); episodes play no part."""
        self.inner_ = clone(self.inner).fit(X, y)
        self.classes_ = self.inner_.classes_
        return self

    def predict_proba(self, X: Any) -> Array:
        """Probabilities of failure and success, shape (n, 2)."""
        return np.asarray(self.inner_.predict_proba(X))

    @property
    def threshold_(self) -> float:
        """Predict success only above this probability of it: where both mistakes cost the same."""
        return self.cost_ratio / (1 + self.cost_ratio)

    def predict(self, X: Any) -> NDArray[Any]:
        """The class with the lower expected cost, shape (n,)."""
        return self.classes_[(self.predict_proba(X)[:, 1] >= self.threshold_).astype(int)]
