"""Poses of the robot's axle for places that name the ball: a distance behind it along the robot's heading there.

Each map has a form on intervals, for certificates of refinement.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.values import Array, Columns

TURN = 2 * np.pi


@dataclass(frozen=True, slots=True)
class Behind:
    """Shifts the places that begin at the columns `at` (x, y, phi, v) back by `distance_m`."""

    at: tuple[int, ...]
    distance_m: float

    def __call__(self, values: Array) -> Array:
        """Map places, shape (n, 8), to poses of the same shape (m, rad, m/s)."""
        moved = np.array(values, dtype=np.float64)
        for at in self.at:
            moved[:, at] -= self.distance_m * np.cos(moved[:, at + 2])
            moved[:, at + 1] -= self.distance_m * np.sin(moved[:, at + 2])
        return moved

    def spans(self, lower: Columns, upper: Columns) -> tuple[Columns, Columns]:
        """Bounds of the poses for places between `lower` and `upper`, one array per column."""
        low, high = list(lower), list(upper)
        for at in self.at:
            for column, quarter in ((at, 0.0), (at + 1, np.pi / 2)):  # a sine is a cosine a quarter turn later
                lowest, highest = _cosines(lower[at + 2] - quarter, upper[at + 2] - quarter)
                low[column] = lower[column] - self.distance_m * highest
                high[column] = upper[column] - self.distance_m * lowest
        return tuple(low), tuple(high)


def _cosines(lower: Array, upper: Array) -> tuple[Array, Array]:
    """Minimum and maximum of the cosine between the angles `lower` and `upper`."""
    ends = np.cos(lower), np.cos(upper)
    opposite = np.floor((upper - np.pi) / TURN) >= np.ceil((lower - np.pi) / TURN)
    ahead = np.floor(upper / TURN) >= np.ceil(lower / TURN)
    return np.where(opposite, -1.0, np.minimum(*ends)), np.where(ahead, 1.0, np.maximum(*ends))
