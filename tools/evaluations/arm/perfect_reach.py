"""Perfect duration model of a reach: the controller's own duration, for an oracle."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tailor.executive.actions.cubic import MAX_S, MIN_S
from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import ACCELERATION_RADPS2

Array = NDArray[np.float64]
STEPS = 160  # of the search, evenly spaced in the logarithm of the duration
HALVINGS = 22


class PerfectReach:
    """See `DurationModel`: exact except for the rounding to whole periods; its spread is 0."""

    card: ClassVar[dict[str, Any]] = {"sha256": "the controller itself"}

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Seconds for (a, wa, b, wb, ag, wag, bg, wbg), shape (n, 8); see actions.cubic for what is minimised."""
        v0, v1 = arguments[:, [1, 3]], arguments[:, [5, 7]]
        way = arguments[:, [4, 6]] - arguments[:, [0, 2]]
        weight = 1.0 / ACCELERATION_RADPS2**2
        e1 = 4 * weight * (v0 * v0 + v0 * v1 + v1 * v1).sum(axis=1)
        e2 = -12 * weight * (way * (v0 + v1)).sum(axis=1)
        e3 = 12 * weight * (way * way).sum(axis=1)
        rates = np.geomspace(1 / MAX_S, 1 / MIN_S, STEPS)
        u = rates[None, :]
        best = (1 / u + u * (e1[:, None] + u * (e2[:, None] + u * e3[:, None]))).argmin(axis=1)
        low, high = rates[np.maximum(best - 1, 0)], rates[np.minimum(best + 1, STEPS - 1)]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            slow = middle * middle * (e1 + middle * (2 * e2 + middle * 3 * e3)) < 1.0
            low, high = np.where(slow, middle, low), np.where(slow, high, middle)
        return 1 / low - PERIOD_S, np.zeros(len(arguments))
