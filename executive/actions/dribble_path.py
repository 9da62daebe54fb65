"""The path to dribble a ball along: the quickest of several radii and of ends that are good enough.

Ends that may be a little off keep the duration smooth: an exact end can cost a full circle where a slant costs nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from executive.actions.dubins import DubinsPath, Pose2, shortest
from executive.belief.planar_ekf import Pose


@dataclass(frozen=True, slots=True)
class DribblePath:
    """Plans paths of bounded curvature that end with a straight run-out."""

    v_max_mps: float
    bend_radps: float  # how fast bends are driven
    radii_m: tuple[float, ...] = (0.48, 0.55, 0.65)  # of bends: the tighter, the slower
    run_out_m: float = 0.15
    slants_rad: tuple[float, ...] = (0.0, 0.3, -0.3)  # a path may end so far off the goal's heading
    asides_m: tuple[float, ...] = (0.0, 0.12, -0.12)  # and so far aside of it
    slant_s_per_rad: float = 4.0  # if it is quicker by as much
    aside_s_per_m: float = 8.0

    def quickest(self, pose: Pose, v: float, goal: tuple[float, ...]) -> DubinsPath:
        """The best path that can be driven from a pose at speed v (m/s) to a goal (x, y, phi, ...)."""
        start = (pose.x, pose.y, pose.phi)
        tightest = v / self.bend_radps
        radii = [radius for radius in self.radii_m if radius >= tightest] or [tightest]
        candidates = []
        for slant in self.slants_rad:
            for aside in self.asides_m:
                blemish_s = self.slant_s_per_rad * abs(slant) + self.aside_s_per_m * abs(aside)
                end = self._end(goal, slant, aside)
                candidates += [(shortest(start, end, radius), blemish_s) for radius in radii]
        best, _ = min(candidates, key=lambda path: self.driving_s(path[0]) + path[1])
        return best.extended(self.run_out_m)

    def driving_s(self, path: DubinsPath) -> float:
        """Roughly how long a path takes, s."""
        bend, straight = self.bend_radps * path.radius, 0.85 * self.v_max_mps
        return sum(length / (bend if turn else straight) for turn, length in path.pieces)

    def _end(self, goal: tuple[float, ...], slant: float, aside: float) -> Pose2:
        """Where the run-out begins."""
        heading = goal[2] + slant
        c, s = math.cos(heading), math.sin(heading)
        return goal[0] - self.run_out_m * c - aside * s, goal[1] - self.run_out_m * s + aside * c, heading
