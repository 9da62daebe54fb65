"""Whether a detour on the way to a ball runs into that ball: goToPose knows of none, so no model of it can tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from executive.actions.planar import PHIG, XG, YG, X, Y
from executive.library import Array

POINTS = np.linspace(0.0, 1.0, 9)  # of the way that are looked at
TOUCHING_M = 0.38  # from the axle to the ball: about what the rail reaches, and the ball's radius
CLEAR_M = 0.55  # with what noise and the bend of the way may add


@dataclass(frozen=True, slots=True)
class BumpRisk:
    """See executive.library.DetourRisk: the risk that the robot touches the ball on its way."""

    lead: float  # goToPose's: it steers at a point this share of the distance behind its goal

    def __call__(self, detours: Array, action: Array) -> Array:
        """Risks, 0 to 1; the way is a parabola, off towards the point behind the goal, in along its heading.

        Args:
          detours: goToPose's parameters, shape (n, 8).
          action: Those of the approach that follows, shape (8,); its goal is the ball's place.
        """
        start, goal = detours[:, [X, Y]], detours[:, [XG, YG]]
        distance = np.hypot(*(goal - start).T)
        heading = np.stack([np.cos(detours[:, PHIG]), np.sin(detours[:, PHIG])], axis=1)
        behind = goal - self.lead * distance[:, None] * heading
        t = POINTS[:, None, None]
        way = (1 - t) ** 2 * start + 2 * t * (1 - t) * behind + t**2 * goal  # (points, n, 2)
        off = way - action[[XG, YG]]
        nearest = np.sqrt((off**2).sum(axis=2).min(axis=0))
        risk: Array = np.clip((CLEAR_M - nearest) / (CLEAR_M - TOUCHING_M), 0.0, 1.0)
        return risk
