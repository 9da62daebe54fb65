"""Lower bound of a bag of trees, mean plus k standard deviations, given bounds of each tree."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]

MIN_STD = np.float32(1e-9)  # s: below, all trees agree
ROUNDS = 6  # of raising outliers: half as many cost a tenth more boxes, twice as many save none


def bag_lower_bound(least: Floats, most: Floats, k_std: float) -> Floats:
    """Lower bound of the mean plus `k_std` standard deviations over the trees.

    The objective is convex in the trees' predictions, so any tangent plane is a lower bound: a mean with the weights
    1 + k z, where z are standard scores. The plane is taken near the optimum. There every tree predicts its minimum,
    but outliers far below the others are raised as long as that costs nothing. If all trees can agree, the optimum is
    a kink, and the bound holds but is not tight.

    Args:
      least: Minimum of each tree, shape (k, ...).
      most: Maximum of each tree, shape (k, ...).
      k_std: Number of standard deviations, positive.

    Returns:
      The bound, shape (...).
    """
    k = np.float32(k_std)
    values = least
    for _ in range(ROUNDS):
        mean, off, std = _moments(values)
        values = np.maximum(least, np.minimum(most, mean - std / k))
    mean, off, std = _moments(values)
    scores: Floats = np.divide(off, np.maximum(std, MIN_STD), dtype=np.float32)
    scores -= _mean(scores)  # not exact where all agree but for rounding
    scores /= np.maximum(np.sqrt(_mean(scores * scores)), np.float32(1))
    weights: Floats = 1 + k * scores
    return _mean(weights * np.where(weights >= 0, least, most))


def _moments(values: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean, deviations from it, and standard deviation, over the trees."""
    count = np.float32(len(values))
    mean: Floats = np.add.reduce(values, axis=0) / count
    off = values - mean
    return mean, off, np.sqrt(np.add.reduce(off * off, axis=0) / count)


def _mean(values: Floats) -> Floats:
    """Mean over the trees; np.mean takes three times as long for few trees."""
    mean: Floats = np.add.reduce(values, axis=0) / np.float32(len(values))
    return mean
