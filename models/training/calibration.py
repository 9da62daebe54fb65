"""Prediction intervals that hold what they promise where they are used: at the optimiser's choices, if those are known.

An interval calibrated on random episodes covers less there (learning.md): the optimiser goes where a model errs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.training import scores

Array = NDArray[np.float64]

LEVEL = 0.9
MIN_POLICY_EPISODES = 30  # on-policy test episodes: fewer say little about a tenth of them


def calibrated(errors: Array, spread: Array, on_policy: NDArray[np.bool_]) -> dict[str, Any]:
    """What a card says of the interval `mean ± factor · spread` that holds 90 % of the errors.

    Args:
      errors, spread: Of test episodes that the model has not seen, shapes (n,).
      on_policy: Which of them the optimiser chose, shape (n,); with enough of these they set the factor.

    Returns:
      `interval90_factor`, `interval90_on` ("on-policy" or "random") and, with both kinds of episodes, the random ones'
      factor and the share of on-policy errors that it would hold.
    """
    random = ~on_policy
    enough = int(on_policy.sum()) >= MIN_POLICY_EPISODES
    used = on_policy if enough else random if random.any() else on_policy
    said: dict[str, Any] = {
        "interval90_factor": scores.interval_factor(errors[used], spread[used], LEVEL),
        "interval90_on": "on-policy" if used is on_policy else "random",
        "interval90_n": int(used.sum()),
    }
    if enough and random.any():
        factor = scores.interval_factor(errors[random], spread[random], LEVEL)
        said["interval90_random_factor"] = factor
        said["interval90_random_covers_pct"] = scores.coverage(errors[on_policy], spread[on_policy], factor)
    return said
