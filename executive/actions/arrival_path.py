"""The way into a goal in motion: straight at an arc that meets the goal's line, along the arc, and a run-in.

Such a path is a Dubins path without its first bend: a robot that can turn on the spot has no need of that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from executive.actions.dubins import DubinsPath, Pose2
from executive.belief.angles import difference

NONE = 1e-6  # rad short of a full circle: a bend of nothing, but for rounding


@dataclass(frozen=True, slots=True)
class ArrivalPath:
    """Plans paths to the origin of the goal's frame, where x points along the goal's heading."""

    v_max_mps: float
    bend_radps: float  # how fast bends are driven
    turn_radps: float  # and turns on the spot, about
    run_in_m: float = 0.10
    inside: float = 0.8  # within the arc: the arc shrinks to this share of what passes through the robot
    tightest_m: float = 0.08

    def quickest(self, start: Pose2, radius: float) -> DubinsPath:
        """The quicker of the paths that end with a left and with a right bend; its start is turned as it must be.

        Args:
          start: Pose in the goal's frame.
          radius: Of the bend, m; it is less where the robot is too near for it.
        """
        paths = [self._ending(start, side, radius) for side in (1, -1)]
        return min(paths, key=lambda path: self.driving_s(path) + self._turning_s(start, path))

    def driving_s(self, path: DubinsPath) -> float:
        """Roughly how long a path takes, s."""
        bend, straight = self.bend_radps * path.radius, 0.85 * self.v_max_mps
        return sum(length / (bend if turn else straight) for turn, length in path.pieces)

    def _turning_s(self, start: Pose2, path: DubinsPath) -> float:
        return abs(difference(path.start[2], start[2])) / self.turn_radps

    def _ending(self, start: Pose2, side: int, radius: float) -> DubinsPath:
        x, y = start[0] + self.run_in_m, side * start[1]  # mirrored, so that the bend turns left
        if y > 0.0:
            radius = max(self.tightest_m, min(radius, self.inside * (x * x + y * y) / (2.0 * y)))
        dx, dy = -x, radius - y
        distance = max(radius, math.hypot(dx, dy))
        heading = math.atan2(dy, dx) - math.asin(radius / distance)
        bend = -heading % math.tau
        bend = bend if bend < math.tau - NONE else 0.0
        straight = math.sqrt(distance * distance - radius * radius)
        pieces = ((0, straight), (side, radius * bend), (0, self.run_in_m))
        return DubinsPath((start[0], start[1], side * heading), radius, pieces)
