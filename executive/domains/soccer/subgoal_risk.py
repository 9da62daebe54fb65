"""Risk that the way to an asserted subgoal meets the ball: hand-made geometry, as goToPose's models have no ball.

Nothing here is learned. It repeats the path planner of the controller and takes the distance from the ball for a risk.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.planar import PHIG, VG, XG, YG, X, Y
from tailor.executive.interfaces.values import Array

POINTS = np.linspace(0.0, 1.0, 6)[:, None]  # of the straight piece, and of the bend, that are looked at
TOUCHING_M = 0.38  # from the axle to the ball: about what the rail reaches, and the ball's radius
CLEAR_M = 0.55  # with what noise may add


@dataclass(frozen=True, slots=True)
class BallContactRisk:
    """Geometric risk that the robot touches the ball on its way; see tailor.executive.interfaces.action.SubgoalRisk."""

    ways: ArrivalPath  # goToPose's

    def __call__(self, subgoals: Array, action: Array) -> Array:
        """Risks, 0 to 1.

        Args:
          subgoals: goToPose's parameters, shape (n, 8).
          action: Those of the approach that follows, shape (8,); its goal is the ball's place.
        """
        off = self._way(subgoals) - action[[XG, YG]]
        nearest = np.sqrt((off**2).sum(axis=2).min(axis=0))
        risk: Array = np.clip((CLEAR_M - nearest) / (CLEAR_M - TOUCHING_M), 0.0, 1.0)
        return risk

    def _way(self, subgoals: Array) -> Array:
        """Points, shape (p, n, 2), of ArrivalPath's way that bends to the side where the start lies."""
        c, s = np.cos(subgoals[:, PHIG]), np.sin(subgoals[:, PHIG])
        dx, dy = (subgoals[:, [X, Y]] - subgoals[:, [XG, YG]]).T
        x, aside = c * dx + s * dy + self.ways.run_in_m, c * dy - s * dx
        side = np.where(aside < 0.0, -1.0, 1.0)
        y = np.maximum(np.abs(aside), 1e-9)  # mirrored, so that the bend is to the left
        radius = np.maximum(self.ways.radius_m, subgoals[:, VG] / self.ways.bend_radps)
        radius = np.maximum(self.ways.tightest_m, np.minimum(radius, self.ways.inside * (x**2 + y**2) / (2 * y)))
        distance = np.maximum(radius, np.hypot(x, radius - y))
        straight = np.sqrt(distance**2 - radius**2)
        heading = _angles((radius - y) * straight + x * radius, radius * (radius - y) - x * straight)
        straight = POINTS * straight
        turned = heading + POINTS * (-heading % (2 * np.pi))
        ahead = np.concatenate([x + straight * np.cos(heading), radius * np.sin(turned)]) - self.ways.run_in_m
        left = side * np.concatenate([y + straight * np.sin(heading), radius * (1 - np.cos(turned))])
        return np.stack([subgoals[:, XG] + c * ahead - s * left, subgoals[:, YG] + s * ahead + c * left], axis=2)


def _angles(sines: Array, cosines: Array) -> Array:
    """Angles (rad) of directions of any length; numpy's own would differ in a last bit from CPU to CPU."""
    return np.array([math.atan2(sine, cosine) for sine, cosine in zip(sines, cosines, strict=True)])
