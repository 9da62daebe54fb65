"""The path to dribble a ball along: the quickest of several radii and of ends that are good enough.

Ends that may be a little off keep the duration smooth: an exact end can cost a full circle where a slant costs nothing.
What they cost is less than the time that they save: else noise in the start, by which one end or another is chosen,
would show in the duration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.actions.dubins import DubinsPath, Pose2, shortest, straight_on
from tailor.executive.belief.planar_ekf import Pose


@dataclass(frozen=True, slots=True)
class DribblePath:
    """Plans paths of bounded curvature that begin and end straight."""

    v_max_mps: float
    bend_radps: float  # how fast bends are driven
    ahead_m: float  # axle to ball
    braking_mps2: float  # on the run-in
    radii_m: tuple[float, ...] = (0.48, 0.65)  # of bends: the tighter, the slower
    run_in_m: float = 0.12  # the ball is to lie in the rail before the first bend
    run_out_m: float = 0.15
    slants_rad: tuple[float, ...] = (0.0, 0.3, -0.3, 0.6, -0.6)  # a path may end so far off the goal's heading
    asides_m: tuple[float, ...] = (0.0, 0.1, -0.1, 0.2, -0.2)  # and so far aside of it
    slant_s_per_rad: float = 2.0  # if it is quicker by as much
    aside_s_per_m: float = 4.0

    def quickest(self, pose: Pose, v: float, goal: tuple[float, ...]) -> DubinsPath:
        """The best path that can be driven from a pose at speed v (m/s) to a goal (x, y, phi, ...)."""
        start = straight_on((pose.x, pose.y, pose.phi), self.run_in_m)
        tightest = math.sqrt(max(0.0, v * v - 2.0 * self.run_in_m * self.braking_mps2)) / self.bend_radps
        radii = [radius for radius in self.radii_m if radius >= tightest] or [tightest]
        candidates = []
        for slant in self.slants_rad:
            for aside in self.asides_m:
                penalty_s = self.slant_s_per_rad * abs(slant) + self.aside_s_per_m * abs(aside)
                end = self._end(goal, slant, aside)
                candidates += [(shortest(start, end, radius), penalty_s) for radius in radii]
        best, _ = min(candidates, key=lambda path: self.driving_s(path[0]) + path[1])
        return best.between(self.run_in_m, self.run_out_m)

    def driving_s(self, path: DubinsPath) -> float:
        """Approximate time to drive a path, s."""
        bend, straight = self.bend_radps * path.radius, 0.85 * self.v_max_mps
        return sum(length / (bend if turn else straight) for turn, length in path.pieces)

    def _end(self, goal: tuple[float, ...], slant: float, aside: float) -> Pose2:
        """Start pose of the run-out: the ball ends at its place at the goal, or beside it."""
        heading = goal[2] + slant
        c, s = math.cos(heading), math.sin(heading)
        ball_x, ball_y, _ = straight_on((goal[0], goal[1], goal[2]), self.ahead_m)
        return straight_on((ball_x - aside * s, ball_y + aside * c, heading), -self.ahead_m - self.run_out_m)
