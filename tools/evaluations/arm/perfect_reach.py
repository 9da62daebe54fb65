"""Duration model of a reach from the controller's own rule: for an oracle."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tailor.executive.actions.cubic import MAX_S, MIN_S
from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import REACH
from tailor.executive.domains.arm.load import accelerations
from tailor.executive.interfaces.values import Array

STEPS = 160  # of the search, evenly spaced in the logarithm of the duration
HALVINGS = 22


class PerfectReach:
    """See `DurationModel`: without the rounding to whole periods; its spread is 0."""

    card: ClassVar[dict[str, Any]] = {"sha256": "the controller itself"}

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Seconds for (a, wa, b, wb, ag, wag, bg, wbg, fa, fb), shape (n, 10)."""
        return _duration_s(arguments) - PERIOD_S, np.zeros(len(arguments))


def _duration_s(arguments: Array) -> Array:
    """Duration of each reach, see actions.cubic; shape (n,)."""
    rows = arguments.tolist()
    limits = np.array([accelerations((r[0], r[2]), (r[4], r[6]), (r[8], r[9])) for r in rows])
    v0, v1 = arguments[:, [1, 3]], arguments[:, [5, 7]]
    way = arguments[:, [4, 6]] - arguments[:, [0, 2]]
    duration_s = _best_s(way, v0, v1, 1.0 / limits**2)
    longest_s = 2.0 * duration_s
    while True:  # as the controller does
        slower = _exceeds(way, v0, v1, duration_s) & (duration_s < longest_s)
        if not slower.any():
            return duration_s
        duration_s = np.where(slower, duration_s + 0.25 * PERIOD_S, duration_s)


def _best_s(way: Array, v0: Array, v1: Array, weight: Array) -> Array:
    e1 = 4 * (weight * (v0 * v0 + v0 * v1 + v1 * v1)).sum(axis=1)
    e2 = -12 * (weight * way * (v0 + v1)).sum(axis=1)
    e3 = 12 * (weight * way * way).sum(axis=1)
    rates = np.geomspace(1 / MAX_S, 1 / MIN_S, STEPS)
    u = rates[None, :]
    best = (1 / u + u * (e1[:, None] + u * (e2[:, None] + u * e3[:, None]))).argmin(axis=1)
    low, high = rates[np.maximum(best - 1, 0)], rates[np.minimum(best + 1, STEPS - 1)]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        slow = middle * middle * (e1 + middle * (2 * e2 + middle * 3 * e3)) < 1.0
        low, high = np.where(slow, middle, low), np.where(slow, high, middle)
    result: Array = 1 / low
    return result


def _exceeds(way: Array, v0: Array, v1: Array, duration_s: Array) -> NDArray[np.bool_]:
    """Whether a cubic of that duration is too fast, or accelerates too much."""
    t = duration_s[:, None]
    b, c = (3 * way / t - 2 * v0 - v1) / t, (v0 + v1 - 2 * way / t) / t**2
    largest = np.maximum(np.linalg.norm(2 * b, axis=1), np.linalg.norm(2 * b + 6 * c * t, axis=1))
    turn_s = np.clip(-b / np.where(c == 0.0, np.inf, 3 * c), 0.0, t)
    turning = np.abs(v0 + 2 * b * turn_s + 3 * c * turn_s**2)
    fastest = np.maximum(turning, np.maximum(np.abs(v0), np.abs(v1))).max(axis=1)
    controller: Any = REACH.controller
    too_much: NDArray[np.bool_] = (largest > controller.acceleration_max_radps2) | (
        fastest > controller.velocity_max_radps
    )
    return too_much
