"""Following a bounded-curvature path: where on it the robot is, how to steer, how fast it may go."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.actions.dubins import DubinsPath
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose

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


@dataclass(frozen=True, slots=True)
class Deviation:
    """Where the robot is against the path: m aside, left positive, and rad turned left of the path's heading."""

    aside_m: float
    turned: float


def project(progress: Progress, pose: Pose, reach_m: float) -> tuple[Progress, Deviation]:
    """Move the progress to where the robot is now, at most `reach_m` on."""
    s = progress.s
    for _ in range(2):  # the path is smooth: two tangent steps are within a millimetre
        x, y, heading, _ = progress.path.at(s)
        along = math.cos(heading) * (pose.x - x) + math.sin(heading) * (pose.y - y)
        s = max(progress.s, min(progress.s + reach_m, s + along))
    x, y, heading, _ = progress.path.at(s)
    aside = math.cos(heading) * (pose.y - y) - math.sin(heading) * (pose.x - x)
    return Progress(progress.path, s), Deviation(aside, difference(pose.phi, heading))


def tracking_curvature(progress: Progress, deviation: Deviation, preview_m: float, settle_m: float) -> float:
    """Curvature (1/m, left positive) that follows the path and takes deviations back critically damped.

    Args:
      progress: Where on the path the robot is.
      deviation: How far off it is.
      preview_m: How far the robot goes until its turning has followed.
      settle_m: Length over which a deviation decays.
    """
    ahead = progress.path.at(progress.s + preview_m)[3]
    return ahead - deviation.aside_m / settle_m**2 - 2.0 * deviation.turned / settle_m


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
