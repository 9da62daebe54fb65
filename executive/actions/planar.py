"""Belief interface of the controllers of driving robots, and the order of their arguments."""

from __future__ import annotations

from typing import Protocol

from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose

# arguments of goToPose and dribbleBall: robot's pose and speed now and at the goal (paper Table 6)
X, Y, PHI, V, XG, YG, PHIG, VG = range(8)


class PlanarBelief(Protocol):
    """A belief with a pose in the map frame and velocities (m/s, rad/s)."""

    @property
    def pose(self) -> Pose: ...  # noqa: D102

    @property
    def v(self) -> float: ...  # noqa: D102

    @property
    def omega(self) -> float: ...  # noqa: D102


class BallBelief(PlanarBelief, Protocol):
    """A belief with a ball: its track in the robot's frame, and its place in the map; None if never seen."""

    @property
    def ball(self) -> BallTrack | None: ...  # noqa: D102

    @property
    def ball_xy(self) -> tuple[float, float] | None: ...  # noqa: D102
