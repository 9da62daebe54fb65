"""Pure pursuit along a bounded-curvature path: where on it the robot is, where to steer, how fast it may go."""

from __future__ import annotations

import math
from dataclasses import dataclass

from executive.actions.dubins import DubinsPath
from executive.belief.planar_ekf import Pose

PREVIEW_STEP_M = 0.1  # the speed limit looks along the path in such steps
PREVIEW_STEPS = 10


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
    """Move the progress to where the robot is now, at most `reach_m` ahead; and the distance aside, m, left positive."""
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


def speed_limit(progress: Progress, v_max: float, v_end: float, omega_max: float, braking: float) -> float:
    """The highest speed (m/s) from which every bend ahead, and the end, can be met braking gently."""
    limit = math.sqrt(v_end * v_end + 2.0 * braking * max(0.0, progress.remaining_m))
    for step in range(PREVIEW_STEPS):
        ahead = step * PREVIEW_STEP_M
        curvature = abs(progress.path.at(progress.s + ahead)[3])
        if curvature > 0.0:
            bend = omega_max / curvature
            limit = min(limit, math.sqrt(bend * bend + 2.0 * braking * ahead))
            break
    return min(v_max, limit)
