"""Calibration of prediction intervals where they are used: on the optimiser's choices, if enough are available.

An interval calibrated on random episodes covers less there (learning.md): the optimiser prefers where a model errs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.training import scores

Array = NDArray[np.float64]

LEVEL = 0.9
MIN_POLICY_EPISODES = 30  # on-policy test episodes: fewer do not determine a tenth of them


def calibrated(errors: Array, std: Array, on_policy: NDArray[np.bool_]) -> dict[str, Any]:
    """Card entries of the interval `mean ± factor · std` that covers 90 % of the errors.

    Args:
      errors: Observed minus predicted values of held-out episodes, shape (n,).
      std: Their predicted standard deviations, shape (n,).
      on_policy: Whether the optimiser chose the episode, shape (n,); if enough are, they alone set the factor.

    Returns:
      `interval90_factor`, `interval90_on` ("on-policy" or "random") and, with both kinds of episodes, the random ones'
      factor and the share of on-policy errors that it would cover.
    """
    random = ~on_policy
    enough = int(on_policy.sum()) >= MIN_POLICY_EPISODES
    used = on_policy if enough else random if random.any() else on_policy
    entries: dict[str, Any] = {
        "interval90_factor": scores.interval_factor(errors[used], std[used], LEVEL),
        "interval90_on": "on-policy" if used is on_policy else "random",
        "interval90_n": int(used.sum()),
    }
    if enough and random.any():
        factor = scores.interval_factor(errors[random], std[random], LEVEL)
        entries["interval90_random_factor"] = factor
        entries["interval90_random_covers_pct"] = scores.coverage(errors[on_policy], std[on_policy], factor)
    return entries
