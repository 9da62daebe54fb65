"""Coverage of prediction intervals on held-out episodes: by thirds of their widths, random and on-policy.

An interval that holds nine tenths of all errors may still hold too few where it is narrow, and the optimiser prefers
where a model is sure; so each third is judged by itself, on random arguments and on the optimiser's choices.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.regression.intervals import LEVEL

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

MIN_EPISODES = 30  # test episodes of a kind: fewer do not determine a tenth of them
THIRDS = 3


def judged(observed: Array, lower: Array, upper: Array, on_policy: Bools) -> dict[str, Any]:
    """Card entries of intervals.

    Args:
      observed: Values of held-out episodes, shape (n,).
      lower: Lower ends, shape (n,).
      upper: Upper ends, shape (n,).
      on_policy: Whether the optimiser chose the episode, shape (n,).

    Returns:
      `intervals`: for "random" and "on_policy" episodes, if there are enough, what `coverage` returns.
    """
    kinds = {"random": ~on_policy, "on_policy": on_policy}
    enough = {name: rows for name, rows in kinds.items() if rows.sum() >= MIN_EPISODES}
    return {
        "intervals": {
            name: coverage(observed[rows], lower[rows], upper[rows])
            for name, rows in (enough or {"all": np.ones_like(on_policy)}).items()
        }
    }


def coverage(observed: Array, lower: Array, upper: Array) -> dict[str, Any]:
    """Percent of the values that intervals hold, in all and by thirds of rising width, and their cost.

    `winkler` is the mean width plus, for each value outside, its distance times 2 / (1 - LEVEL): the proper score of an
    interval (Winkler 1972), in the unit of the values.
    """
    held = (observed >= lower) & (observed <= upper)
    order = np.argsort(upper - lower, kind="stable")
    outside = np.maximum(lower - observed, 0) + np.maximum(observed - upper, 0)
    return {
        "n": len(observed),
        "covers_pct": float(100 * held.mean()),
        "covers_thirds_pct": [float(100 * held[part].mean()) for part in np.array_split(order, THIRDS)],
        "width": float(np.mean(upper - lower)),
        "winkler": float(np.mean(upper - lower + 2 / (1 - LEVEL) * outside)),
    }
