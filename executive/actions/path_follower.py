"""Pure pursuit along a bounded-curvature path: where on it the robot is, where to steer, how fast it may go."""

from __future__ import annotations

import math
from dataclasses import dataclass

from executive.actions.dubins import DubinsPath
from executive.belief.planar_ekf import Pose

BEND_RESERVE_M = 0.15  # braking ends so far before a bend


@dataclass(frozen=True, slots=True)
class Progress:
    """A path and how far along it the robot is, m."""

    path: DubinsPath
    s: float

    @property
    def remaining_m(self) -> float:
        """To the path's end; negative beyond it."""
        return self.path.length - self.s


def project(progress: Progress, pose: Pose, reach_m: float) -> tuple[Progress, float]:
    """Move the progress to where the robot is now, at most `reach_m` on; and how far it is aside, m, left positive."""
    s = progress.s
    aside = 0.0
    for _ in range(2):  # the path is smooth: two tangent steps are within a millimetre
        x, y, heading, _ = progress.path.at(s)
        c, si = math.cos(heading), math.sin(heading)
        dx, dy = pose.x - x, pose.y - y
        s += max(-reach_m, min(reach_m, c * dx + si * dy))
        aside = c * dy - si * dx
    return Progress(progress.path, max(progress.s, s)), aside


def pursuit_curvature(progress: Progress, pose: Pose, lookahead_m: float) -> float:
    """Curvature (1/m, left positive) of the arc from the pose to the path's point `lookahead_m` further on."""
    x, y, _, _ = progress.path.at(progress.s + lookahead_m)
    dx, dy = x - pose.x, y - pose.y
    left = math.cos(pose.phi) * dy - math.sin(pose.phi) * dx
    return 2.0 * left / max(dx * dx + dy * dy, 0.25 * lookahead_m * lookahead_m)


@dataclass(frozen=True, slots=True)
class Pace:
    """How fast a path may be driven: m/s, and m/s² of braking on straights and in bends."""

    v_max: float
    v_bend: float
    straight_braking: float
    bend_braking: float


def speed_limit(progress: Progress, v_end: float, pace: Pace) -> float:
    """The highest speed (m/s) from which the next bend and the end can be met braking no harder than the pace's."""
    energy_end = v_end * v_end
    to_bend: float | None = None
    begin = 0.0
    for turn, length in progress.path.pieces:
        ahead = min(length, begin + length - progress.s)
        if ahead > 0.0:
            energy_end += 2.0 * ahead * (pace.bend_braking if turn else pace.straight_braking)
            if turn and to_bend is None:
                to_bend = max(0.0, begin - progress.s)
        begin += length
    limit = min(pace.v_max, math.sqrt(energy_end))
    if to_bend is not None:
        room = max(0.0, to_bend - BEND_RESERVE_M)
        limit = min(limit, math.sqrt(pace.v_bend**2 + 2.0 * room * pace.straight_braking))
    return limit
