"""Whether two paired samples have the same mean within a margin: two one-sided t-tests (Schuirmann's TOST).

A t-test that finds no difference proves nothing; this one does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats


@dataclass(frozen=True, slots=True)
class Equivalence:
    """Second minus first, in the samples' unit."""

    difference: float
    ci95: tuple[float, float]
    p_different: float  # two-sided paired t-test
    p_equivalent: float  # the larger of both one-sided tests; small: the means are less than the margin apart


def equivalence(first: ArrayLike, second: ArrayLike, margin: float) -> Equivalence:
    """Test two paired samples of shape (n,), n >= 2.

    Args:
      margin: The largest difference of the means that does not matter; positive, and not chosen by looking at the data.

    Raises:
      ValueError: Fewer than two pairs, lengths that differ, or no margin.
    """
    apart = np.subtract(np.asarray(second, dtype=np.float64), np.asarray(first, dtype=np.float64))
    if apart.ndim != 1 or len(apart) < 2 or margin <= 0:
        raise ValueError(f"{apart.shape} differences and margin {margin:g}, expected at least two and a positive one")
    mean, freedom = float(apart.mean()), len(apart) - 1
    error = float(stats.sem(apart))
    if error == 0:  # all differences are one and the same: nothing to test
        return Equivalence(mean, (mean, mean), float(mean == 0), float(abs(mean) >= margin))
    half = float(stats.t.ppf(0.975, freedom)) * error
    sides = [float(stats.t.sf((margin + sign * mean) / error, freedom)) for sign in (1, -1)]
    p_different = float(2 * stats.t.sf(abs(mean) / error, freedom))
    return Equivalence(mean, (mean - half, mean + half), p_different, max(sides))
