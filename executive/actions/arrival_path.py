"""Ways into a goal in motion: straight at an arc that meets the goal's line, along it, and a short run-in.

Such a way is a Dubins path (Dubins, American Journal of Mathematics 79, 1957) without its first bend: a robot that can
turn on the spot has no need of that. Poses are in the goal's frame: the goal is its origin, x its heading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.actions.dubins import DubinsPath, Pose2
from tailor.executive.belief.angles import difference

NO_BEND = 1e-6  # rad short of a full circle: a bend of zero length with rounding errors


@dataclass(frozen=True, slots=True)
class ArrivalPath:
    """Plans ways into a goal.

    Right before it no bend may fit: the way is then the goal's line, though the robot is a little beside it.
    """

    v_max_mps: float
    radius_m: float = 0.45  # of the bend, for goals that are passed slowly
    bend_radps: float = 1.2  # how fast bends are driven
    run_in_m: float = 0.10
    inside: float = 0.8  # within the arc it shrinks to this share of the one that passes through the robot,
    tightest_m: float = 0.08  # but not to less than this
    # for the choice among ways: bends cost more than driving them, there is braking before them
    bend_worth_radps: float = 0.9
    facing_radps: float = 1.3
    beside_m: float = 0.12  # right before its goal the robot may go on so far beside the goal's line,
    aside_s_per_m: float = 20.0  # where else it would lose as much

    def radius(self, vg: float) -> float:
        """Of the bend (m) into a goal that is passed at `vg` (m/s): the faster, the wider."""
        return max(self.radius_m, vg / self.bend_radps)

    def quickest(self, start: Pose2, vg: float) -> DubinsPath:
        """The quickest way; the robot has first to turn to its start's heading.

        Args:
          start: Pose in the goal's frame (m, m, rad).
          vg: Speed at the goal, m/s.
        """
        x, y, heading = start
        radius = self.radius(vg)
        along = DubinsPath((x, 0.0, 0.0), radius, ((0, 0.0), (1, 0.0), (0, max(0.0, -x))))
        paths = (self._bent(x, y, 1, radius), self._bent(x, y, -1, radius))
        best_s, best = min(((self._roughly_s(path, heading), path) for path in paths), key=lambda found: found[0])
        along_s = self._roughly_s(along, heading) + self.aside_s_per_m * abs(y)
        return along if x < 0.0 and abs(y) < self.beside_m and along_s < best_s else best

    def _bent(self, x: float, y: float, side: int, radius: float) -> DubinsPath:
        """The way that ends with a bend to the left (side 1) or right (-1)."""
        x, aside = x + self.run_in_m, side * y  # mirrored, so that the bend is to the left
        if aside > 0.0:
            through_robot = (x * x + aside * aside) / (2.0 * aside)
            radius = max(self.tightest_m, min(radius, self.inside * through_robot))
        dx, dy = -x, radius - aside  # to the arc's centre
        distance = max(radius, math.hypot(dx, dy))
        heading = math.atan2(dy, dx) - math.asin(radius / distance)
        bend = -heading % math.tau
        bend = bend if bend < math.tau - NO_BEND else 0.0
        straight = math.sqrt(distance * distance - radius * radius)
        pieces = ((0, straight), (side, radius * bend), (0, self.run_in_m))
        return DubinsPath((x - self.run_in_m, y, side * heading), radius, pieces)

    def _roughly_s(self, path: DubinsPath, heading: float) -> float:
        """Approximate time (s) to turn towards the path and drive it."""
        facing = abs(difference(path.start[2], heading)) / self.facing_radps
        (_, straight), (_, bend), (_, run_in) = path.pieces
        return facing + (straight + run_in) / (0.85 * self.v_max_mps) + bend / (self.bend_worth_radps * path.radius)
