"""Predictions for rows whose episodes the model has not seen: the basis of weights, choices and intervals."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

FOLDS = 4


def held_out_parts(groups: NDArray[Any], seed: int) -> Iterator[Bools]:
    """FOLDS disjoint masks of rows, (n,), that cover all rows and never divide an episode."""
    _, number = np.unique(groups, return_inverse=True)
    part = np.random.default_rng(seed).permutation(number.max() + 1) % FOLDS
    for fold in range(FOLDS):
        yield part[number] == fold


def out_of_fold(make: Callable[[], Any], X: Array, y: Array, groups: NDArray[Any], seed: int) -> tuple[Array, Array]:
    """Mean and standard deviation, shapes (n,), of each row by a model fitted without its fold.

    Args:
      make: Makes an unfitted `RegressionModel`.
      X: Features, shape (n, f).
      y: Targets, shape (n,).
      groups: Episode of each row, shape (n,).
      seed: Seed of the folds.
    """
    mean, std = np.empty(len(y)), np.empty(len(y))
    for apart in held_out_parts(groups, seed):
        kept = ~apart
        mean[apart], std[apart] = make().fit(X[kept], y[kept], groups=groups[kept]).predict_with_std(X[apart])
    return mean, std
