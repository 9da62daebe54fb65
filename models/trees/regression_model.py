"""Base of the estimators of durations and energies: scikit-learn regressors that also predict a standard deviation."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, RegressorMixin

Values = NDArray[np.floating[Any]]


class RegressionModel(RegressorMixin, BaseEstimator, ABC):  # type: ignore[misc]
    """Predicts seconds (or joules) with a standard deviation."""

    @abstractmethod
    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to observed values.

        Args:
          X: Features, shape (n, f).
          y: Seconds (or joules), shape (n,).
          groups: Episode of each row, shape (n,); None if every row is an episode of its own.
        """

    @abstractmethod
    def predict_with_std(self, X: Any) -> tuple[Values, Values]:
        """Mean and standard deviation in the targets' unit, shapes (n,), of features (n, f)."""

    def predict(self, X: Any) -> Values:
        """Mean in the targets' unit, shape (n,), of features (n, f)."""
        return self.predict_with_std(X)[0]
