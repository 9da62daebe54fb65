"""n_i: how many first ticks of each episode a learner is fitted to, chosen by cross-validation (paper 5.1)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone

from tailor.models.episodes.episodes import Episode
from tailor.models.episodes.examples import Examples, folds
from tailor.models.episodes.regression_targets import RegressionTarget
from tailor.models.features.features import FeatureSpace
from tailor.models.training.fitting import absolute_errors, fitted

Array = NDArray[np.float64]

FIRST_TICKS = (1, 2, 5, 10, 20)  # candidates for n_i
FOLDS = 4
CLEARLY = 2.0  # standard errors of a difference


def best_n_i(
    target: RegressionTarget,
    episodes: Sequence[Episode],
    kept: NDArray[np.int64],
    space: FeatureSpace,
    singles: Sequence[Any],
    rng: np.random.Generator,
) -> int:
    """Number of first ticks with which one of `singles` has the least error on whole durations, cross-validated.

    A tree gains by the many rows of many ticks where a network does not, so the learner that ships decides. More ticks
    must be better by CLEARLY: they make durations too short, which the error hardly shows.
    """
    first = target.examples(episodes, 1)
    parts = folds(kept, FOLDS, rng)
    best, least = FIRST_TICKS[0], np.empty(0)
    for n_i in FIRST_TICKS:
        rows = target.examples(episodes, n_i)
        each = (_cross_validated_errors(single, rows, first, kept, parts, space) for single in singles)
        errors = min(each, key=lambda found: float(found.mean()))
        if not len(least) or _is_clearly_less(errors, least):
            best, least = n_i, errors
    return best


def _is_clearly_less(errors: Array, others: Array) -> bool:
    """Whether errors on the same episodes, (n,) each, are less by CLEARLY standard errors of their difference."""
    more = errors - others
    return bool(more.mean() + CLEARLY * more.std() / np.sqrt(len(more)) < 0.0)


def _cross_validated_errors(
    learner: Any,
    rows: Examples,
    first: Examples,
    kept: NDArray[np.int64],
    parts: Sequence[NDArray[np.int64]],
    space: FeatureSpace,
) -> Array:
    """Errors on the `first` rows of each part, (n,), of a copy of `learner` fitted to the `rows` of the other parts."""
    errors = []
    for part in parts:
        copy = fitted(clone(learner), rows.of(np.setdiff1d(kept, part)), space)
        errors.append(absolute_errors(copy, first.of(part), space))
    return np.concatenate(errors)
