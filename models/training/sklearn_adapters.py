"""Adapters that give scikit-learn's estimators our interface: boosting, networks, support vectors (paper 8)."""

from __future__ import annotations

from typing import Any, Self
from warnings import catch_warnings, simplefilter

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from sklearn.exceptions import ConvergenceWarning
from sklearn.metrics import log_loss
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
      patient: The same without an early end of its training; taken where the classifier has hardly begun to learn.
    """

    def __init__(self, inner: Any, cost_ratio: float = 1.0, patient: Any = None) -> None:
        self.inner = inner
        self.cost_ratio = cost_ratio
        self.patient = patient

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and outcomes (n,); groups are ignored."""
        with threadpool_limits(1):  # networks: several threads may sum in another order
            self.inner_ = clone(self.inner).fit(X, y)
            if self.patient is not None and self._has_hardly_begun(X, y):
                self.inner_ = _fitted_to_the_end(self.patient, X, y)
        self.classes_ = self.inner_.classes_
        return self

    def _has_hardly_begun(self, X: Any, y: Any) -> bool:
        """Whether the share of each outcome alone predicts those that were learned from as well.

        scikit-learn's networks stop once accuracy no longer rises: where failures are rare, in the first epochs.
        """
        shares = np.full((len(y), 2), np.mean(np.asarray(y)[:, None] == self.inner_.classes_, axis=0))
        return bool(log_loss(y, self.predict_proba(X)) >= log_loss(y, shares))

    def predict_proba(self, X: Any) -> Array:
        """Probabilities of failure and success, shape (n, 2)."""
        return np.asarray(self.inner_.predict_proba(X))


def _fitted_to_the_end(estimator: Any, X: Any, y: Any) -> Any:
    """A copy that is trained for all its epochs: their number is meant, so no warning of it helps anybody."""
    with catch_warnings():
        simplefilter("ignore", ConvergenceWarning)
        return clone(estimator).fit(X, y)
