"""The path to dribble a ball along: the quickest of several radii and of ends that are good enough.

Ends that may be a little off keep the duration smooth: an exact end can cost a full circle where a slant costs nothing.
What they cost is less than the time that they save: else noise in the start, by which one end or another is chosen,
would show in the duration.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from tailor.executive.actions.dubins import DubinsPath, Pieces, Pose2, shortest_pieces, straight_on
from tailor.executive.actions.path_follower import BEND_RESERVE_M
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose


@dataclass(frozen=True, slots=True)
class DribblePath:
    """Plans paths of bounded curvature that begin and end straight."""

    v_max_mps: float
    bend_mps: Callable[[float], float]  # speed in a bend of a radius (m)
    ahead_m: float  # axle to ball
    speeding_up_mps2: float
    braking_mps2: float  # on straights
    radii_m: tuple[float, ...] = (0.36, 0.42, 0.48, 0.56, 0.65)  # of bends: the tighter, the slower
    run_in_m: float = 0.12  # the ball is to lie in the rail before the first bend
    run_out_m: float = 0.15
    # a path may end so far off the goal's heading
    slants_rad: tuple[float, ...] = (0.0, 0.15, -0.15, 0.3, -0.3, 0.45, -0.45, 0.6, -0.6)
    asides_m: tuple[float, ...] = (0.0, 0.1, -0.1, 0.2, -0.2)  # and so far aside of it
    slant_s_per_rad: float = 2.0  # if it is quicker by as much
    aside_s_per_m: float = 4.0
    widest_aside_m: float = 0.3  # of a stop straight ahead: near the goal and in motion, each bend would cost a circle
    _ends: tuple[tuple[float, float, float], ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Sort the ends by what they cost (s): penalty, slant, aside."""
        ends = [
            (self.slant_s_per_rad * abs(slant) + self.aside_s_per_m * abs(aside), slant, aside)
            for slant in self.slants_rad
            for aside in self.asides_m
        ]
        object.__setattr__(self, "_ends", tuple(sorted(ends, key=lambda end: end[0])))

    def quickest(self, pose: Pose, v: float, goal: tuple[float, ...]) -> DubinsPath:
        """The best path that can be driven from a pose at speed v (m/s) to a goal (x, y, phi, ...)."""
        start = straight_on((pose.x, pose.y, pose.phi), self.run_in_m)
        speeds = [(radius, self.bend_mps(radius)) for radius in self._radii(v)]
        straight, best_s = self._straight_ahead(pose, v, goal)
        best = None
        for penalty_s, slant, aside in self._ends:
            end = self._end(goal, slant, aside)
            distance, turned = math.dist(start[:2], end[:2]), abs(difference(end[2], start[2]))
            for radius, bend in speeds:
                if penalty_s + self._least_s(distance, turned * radius, bend) >= best_s:
                    continue  # no path there can be the best: planning would take a fifth of an episode's time
                pieces = shortest_pieces(start, end, radius)
                cost_s = self.driving_s(pieces, bend, v, goal[3]) + penalty_s
                if cost_s < best_s:
                    best, best_s = (radius, pieces), cost_s
        return straight if best is None else DubinsPath(start, *best).between(self.run_in_m, self.run_out_m)

    def _straight_ahead(self, pose: Pose, v: float, goal: tuple[float, ...]) -> tuple[DubinsPath, float]:
        """The straight line on which the ball comes nearest to its place, and its cost, s; infinite: too far aside."""
        slant = abs(difference(goal[2], pose.phi))
        ball_x, ball_y, _ = straight_on((goal[0], goal[1], goal[2]), self.ahead_m)
        c, s = math.cos(pose.phi), math.sin(pose.phi)
        dx, dy = ball_x - pose.x, ball_y - pose.y
        length = max(0.0, c * dx + s * dy - self.ahead_m, (v * v - goal[3] * goal[3]) / (2.0 * self.braking_mps2))
        aside = math.hypot(c * dx + s * dy - self.ahead_m - length, c * dy - s * dx)
        path = DubinsPath((pose.x, pose.y, pose.phi), self.radii_m[-1], ((0, length),))
        if aside > self.widest_aside_m or slant > self.slants_rad[-2]:
            return path, math.inf
        penalty_s = self.slant_s_per_rad * slant + self.aside_s_per_m * aside
        return path, self._straight_s(length, v, goal[3]) + penalty_s

    def _least_s(self, distance: float, bend_m: float, bend: float) -> float:
        """Lower bound of `driving_s` for paths of at least `distance` with at least `bend_m` (m) in bends."""
        straight = max(0.0, distance - bend_m) / max(bend, self.v_max_mps)
        return (bend_m + BEND_RESERVE_M) / bend + straight

    def _radii(self, v: float) -> list[float]:
        """The radii (m) of bends that a robot at speed v (m/s) can brake for; if none, the tightest wider one."""
        slowest = math.sqrt(max(0.0, v * v - 2.0 * self.run_in_m * self.braking_mps2))
        radii = [radius for radius in self.radii_m if self.bend_mps(radius) >= slowest]
        wider = max(self.radii_m)
        while self.bend_mps(wider) < slowest:
            wider *= 1.05
        return radii or [wider]

    def driving_s(self, pieces: Pieces, bend: float, v: float, vg: float) -> float:
        """Approximate time to drive a path, s, with speed `bend` in bends, from speed v to vg (m/s)."""
        (_, first), (turn, middle), (_, last) = pieces
        if turn:
            return (first + middle + last + BEND_RESERVE_M) / bend
        straight = self._straight_s(middle, bend if first else max(v, 0.1), bend if last else vg)
        return (first + last + BEND_RESERVE_M) / bend + straight

    def _straight_s(self, length: float, v: float, v_end: float) -> float:
        """Time (s) on a straight line between two speeds (m/s)."""
        up, down = self.speeding_up_mps2, self.braking_mps2
        peak = math.sqrt((2.0 * up * down * length + down * v * v + up * v_end * v_end) / (up + down))
        peak = max(v, v_end, min(self.v_max_mps, peak))
        changing = (peak * peak - v * v) / (2.0 * up) + (peak * peak - v_end * v_end) / (2.0 * down)
        steady_s = (length - changing) / peak if length > changing else 0.0  # at rest on the goal, peak is 0
        return (peak - v) / up + (peak - v_end) / down + steady_s

    def _end(self, goal: tuple[float, ...], slant: float, aside: float) -> Pose2:
        """Start pose of the run-out: the ball ends at its place at the goal, or beside it."""
        heading = goal[2] + slant
        c, s = math.cos(heading), math.sin(heading)
        ball_x, ball_y, _ = straight_on((goal[0], goal[1], goal[2]), self.ahead_m)
        return straight_on((ball_x - aside * s, ball_y + aside * c, heading), -self.ahead_m - self.run_out_m)
