"""Student's t-interval of a mean over independent tasks or starts."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats


def half_width(values: ArrayLike) -> NDArray[np.float64]:
    """Half the width of the 95 % interval of the mean over the first axis, n >= 2."""
    each = np.asarray(values, np.float64)
    half: NDArray[np.float64] = stats.t.ppf(0.975, len(each) - 1) * stats.sem(each)
    return half
