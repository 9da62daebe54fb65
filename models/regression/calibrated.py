"""A regressor with prediction intervals calibrated on its errors out of fold."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from sklearn.utils.validation import check_is_fitted, validate_data

from tailor.models.episodes.episode_groups import episode_indices
from tailor.models.regression.intervals import OWN, RANDOM, Rows, fit_intervals
from tailor.models.regression.out_of_fold import out_of_fold
from tailor.models.trees.regression_model import RegressionModel, Values

Array = NDArray[np.float64]

NOT_JUDGED = -1  # kind of episodes that are learned from, but say nothing about the intervals


class CalibratedRegressor(RegressionModel):
    """Any `RegressionModel`, and intervals that hold nine tenths of the errors it makes on unseen episodes.

    Args:
      inner: The regressor.
      random_state: Seed of the folds.
    """

    def __init__(self, inner: Any, random_state: int = 0) -> None:
        self.inner = inner
        self.random_state = random_state

    def fit(self, X: Any, y: Any, groups: Any = None, kinds: Any = None, choices: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); see `RegressionModel.fit`.

        The intervals are those of the first row of each episode: predictions are made before an action starts.
        `kinds`, shape (n,), is the kind of each row's episode, as `fit_intervals` has them, or `NOT_JUDGED` if the
        intervals are not for actions as this one; None: all are of one kind. `choices`, features (c, f) and seconds
        (c,), are episodes that this very model chose: it is not fitted to them, and they correct its intervals.

        Raises:
          ValueError: The rows are not finite numbers.
        """
        X, y = validate_data(self, X, y, y_numeric=True, dtype=np.float64)
        episodes = episode_indices(groups, len(y))
        self.inner_ = clone(self.inner).fit(X, y, groups=episodes)
        unseen = getattr(self.inner_, "out_of_fold_", None)  # a learner that was chosen by its errors has them
        mean, std = unseen or out_of_fold(lambda: clone(self.inner), X, y, episodes, self.random_state)
        _, first = np.unique(episodes, return_index=True)
        kinds = np.full(len(y), RANDOM) if kinds is None else np.asarray(kinds)
        first = first[kinds[first] != NOT_JUDGED]
        rows, groups, kinds = Rows(X[first], std[first], (y - mean)[first]), episodes[first], kinds[first]
        if choices is not None:
            own = self._errors_at(*choices)
            numbers = episodes.max() + 1 + np.arange(len(own.errors))
            rows, groups = rows.and_those_of(own), np.concatenate([groups, numbers])
            kinds = np.concatenate([kinds, np.full(len(numbers), OWN)])
        self.intervals_ = fit_intervals(rows, groups, self.random_state, kinds)
        return self

    def _errors_at(self, X: Any, y: Any) -> Rows:
        """Errors of the fitted model at features (c, f) with seconds (c,), of which it has seen none."""
        X = validate_data(self, X, dtype=np.float64, reset=False)
        mean, std = self.predict_with_std(X)
        return Rows(X, np.asarray(std, np.float64), np.asarray(y - mean, np.float64))

    def predict_with_std(self, X: Any) -> tuple[Values, Values]:
        """Mean and standard deviation of the inner model, shapes (n,)."""
        check_is_fitted(self)
        mean_std: tuple[Values, Values] = self.inner_.predict_with_std(X)
        return mean_std

    def predict_interval(self, X: Any) -> tuple[Array, Array, Array]:
        """Mean, and the ends of the interval around it, shapes (n,), of features (n, f)."""
        mean, std = (np.asarray(values, np.float64) for values in self.predict_with_std(X))
        lower, upper = self.intervals_.around(np.asarray(X, np.float32), mean, std)
        return mean, lower, upper
