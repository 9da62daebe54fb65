"""What a bag of trees says at least, mean plus k standard deviations, while each tree keeps between two values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]

MIN_STD = np.float32(1e-9)  # s: below, all trees agree
ROUNDS = 6  # of raising outliers: half as many cost a tenth more boxes, twice as many save none


def bag_lower_bound(least: Floats, most: Floats, k_std: float) -> Floats:
    """The least mean plus `k_std` standard deviations, shape (...), of trees between `least` and `most`, (k, ...).

    That is convex in what the trees say, and its tangent plane anywhere bounds it from below: a mean with the weights
    1 + k z, z being standard scores. It touches near the optimum, where every tree says the least that it can, but
    those far below the others are raised to where that costs nothing. (Where the optimum is a kink, for all can agree,
    the bound holds but is not tight.)
    """
    k = np.float32(k_std)
    said = least
    for _ in range(ROUNDS):
        mean, off, spread = _moments(said)
        said = np.maximum(least, np.minimum(most, mean - spread / k))
    mean, off, spread = _moments(said)
    scores: Floats = np.divide(off, np.maximum(spread, MIN_STD), dtype=np.float32)
    scores -= _mean(scores)  # where all agree but for rounding, they are not yet
    scores /= np.maximum(np.sqrt(_mean(scores * scores)), np.float32(1))
    weights: Floats = 1 + k * scores
    return _mean(weights * np.where(weights >= 0, least, most))


def _moments(said: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean, what each is off it, and standard deviation."""
    count = np.float32(len(said))
    mean: Floats = np.add.reduce(said, axis=0) / count
    off = said - mean
    return mean, off, np.sqrt(np.add.reduce(off * off, axis=0) / count)


def _mean(values: Floats) -> Floats:
    """Over the trees: numpy's own takes three times as long where there are few."""
    mean: Floats = np.add.reduce(values, axis=0) / np.float32(len(values))
    return mean
