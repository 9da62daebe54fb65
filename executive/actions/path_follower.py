"""Following of a bounded-curvature path: progress, curvature command, speed limit."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.actions.dubins import DubinsPath
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose

BEND_RESERVE_M = 0.15  # braking ends this distance before a bend


@dataclass(frozen=True, slots=True)
class Progress:
    """A path and the robot's arc length on it, m."""

    path: DubinsPath
    s: float

    @property
    def remaining_m(self) -> float:
        """Distance to the path's end, m; negative beyond it."""
        return self.path.length - self.s


@dataclass(frozen=True, slots=True)
class Deviation:
    """The robot relative to the path: metres aside, left positive, and radians left of the path's heading."""

    aside_m: float
    turned: float


def project(progress: Progress, pose: Pose, reach_m: float) -> tuple[Progress, Deviation]:
    """Update the progress from the robot's pose, by at most `reach_m`; it never decreases."""
    s = progress.s
    for _ in range(2):  # the path is smooth: two tangent steps are within a millimetre
        x, y, heading, _ = progress.path.at(s)
        along = math.cos(heading) * (pose.x - x) + math.sin(heading) * (pose.y - y)
        s = max(progress.s, min(progress.s + reach_m, s + along))
    x, y, heading, _ = progress.path.at(s)
    aside = math.cos(heading) * (pose.y - y) - math.sin(heading) * (pose.x - x)
    return Progress(progress.path, s), Deviation(aside, difference(pose.phi, heading))


def tracking_curvature(progress: Progress, deviation: Deviation, preview_m: float, settle_m: float) -> float:
    """Curvature (1/m, left positive) that follows the path; deviations decay critically damped.

    Args:
      progress: The robot's place on the path.
      deviation: The robot relative to the path.
      preview_m: Distance that the robot drives until its turning has followed the command.
      settle_m: Length over which a deviation decays.
    """
    ahead = progress.path.at(progress.s + preview_m)[3]
    return ahead - deviation.aside_m / settle_m**2 - 2.0 * deviation.turned / settle_m


@dataclass(frozen=True, slots=True)
class Pace:
    """Limits for a path: speeds in m/s, and braking in m/s² on straights and in bends."""

    v_max: float
    v_bend: float
    straight_braking: float
    bend_braking: float


def speed_limit(progress: Progress, v_end: float, pace: Pace) -> float:
    """The highest speed (m/s) from which next bend and end can be met within the braking limits of `pace`."""
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
