"""Scores of models: errors with confidence intervals over episodes, confusion matrices, calibration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
BOOTSTRAPS = 2000
MIN_STD = 1e-3  # s, floor of predicted standard deviations


def mean_with_ci(values: Array, rng: np.random.Generator) -> tuple[float, tuple[float, float]]:
    """Mean of one value per episode, shape (n,), and its bootstrapped 95 % interval."""
    draws = rng.integers(0, len(values), (BOOTSTRAPS, len(values)))
    low, high = np.quantile(values[draws].mean(axis=1), [0.025, 0.975])
    return float(values.mean()), (float(low), float(high))


@dataclass(frozen=True, slots=True)
class Confusion:
    """Table 2: shares of episodes in percent, predicted against observed, and the number of episodes."""

    fail_fail: float  # predicted fail, observed fail
    fail_success: float  # false alarm
    success_fail: float  # missed failure
    success_success: float
    n: int

    @property
    def accuracy(self) -> float:
        """Percent predicted correctly."""
        return self.fail_fail + self.success_success


def confusion(predicted: NDArray[np.bool_], observed: NDArray[np.bool_]) -> Confusion:
    """Confusion matrix of predicted and observed successes, shapes (n,)."""
    a, b, c, d = (
        float(100 * np.mean((predicted == p) & (observed == o))) for p in (False, True) for o in (False, True)
    )
    return Confusion(a, b, c, d, len(observed))


def interval_factor(errors: Array, std: Array, level: float = 0.9) -> float:
    """Factor for which `mean ± factor · std` covers a share `level` of the errors.

    The rank is that of split conformal prediction, ceil((n + 1) level), at most n, so that it covers fresh errors, too.

    Args:
      errors: Observed minus predicted, shape (n,).
      std: Predicted standard deviations, shape (n,).
      level: Share to cover, 0..1.
    """
    ratios = np.sort(np.abs(errors) / np.maximum(std, MIN_STD))
    return float(ratios[min(len(ratios), int(np.ceil((len(ratios) + 1) * level))) - 1])


def coverage(errors: Array, std: Array, factor: float) -> float:
    """Percent of the errors that `mean ± factor · std` covers."""
    return float(100 * np.mean(np.abs(errors) <= factor * np.maximum(std, MIN_STD)))


def reliability(probability: Array, success: NDArray[np.bool_], bins: int = 10) -> list[tuple[float, float, int]]:
    """Mean predicted probability, observed share and count, by bins of the prediction; empty bins are left out."""
    place = np.minimum((probability * bins).astype(int), bins - 1)
    return [
        (float(probability[place == k].mean()), float(success[place == k].mean()), int((place == k).sum()))
        for k in range(bins)
        if (place == k).any()
    ]
