"""Error models of the AGILO robot's sensors: encoders, and a camera that measures robot pose, ball and opponents.

Every random number comes from the generator of `Sensors.reset`. Metres, radians, seconds.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from tailor.schemas.messages.soccer import BallPercept, Opponent, OpponentPercept, OpponentPercepts
from tailor.simnodes.planar_sensing import PlanarSensing, PlanarSensors


@dataclass(frozen=True, slots=True)
class Sensing(PlanarSensing):
    """Parameters of the error models; see PlanarSensing."""

    pose_sigma_m: float = 0.045
    pose_sigma_rad: float = 0.04  # 2.3°
    pose_dropout: float = 0.03
    odom_scale: float = 0.01
    odom_v_mps: float = 0.008
    odom_omega_radps: float = 0.015
    ball_dropout: float = 0.03
    ball_base_m: float = 0.01
    ball_share: float = 0.05  # of the range, along the line of sight; half of it across
    ball_half_view: float = math.radians(50)
    ball_near_m: float = 0.25
    ball_far_m: float = 6.0
    opponent_dropout: float = 0.10  # found less often than a ball, and measured alike
    opponent_radius_m: float = 0.02
    camera_delay_ns: int = 0  # a multiple of the firmware's period


class Sensors(PlanarSensors):
    """Converts true states to noisy messages."""

    def __init__(self, sensing: Sensing) -> None:
        self._s = sensing
        super().__init__(sensing)

    def ball(self, stamp_ns: int, ahead: float, left: float) -> BallPercept | None:
        """Measured position of a ball at (ahead, left), base_link; None if the percept is lost or out of view."""
        seen = self._sight(ahead, left)
        if self._lost(self._s.ball_dropout) or seen is None:
            return None
        return BallPercept(stamp_ns, *seen)

    def opponents(
        self, stamp_ns: int, pose: tuple[float, float, float], standing: Iterable[Opponent]
    ) -> OpponentPercepts:
        """The opponents that a picture from a pose (m, m, rad; map frame) shows; none hides another one."""
        x, y, phi = pose
        c, s = math.cos(phi), math.sin(phi)
        found = []
        for opponent in standing:
            dx, dy = opponent.x - x, opponent.y - y
            seen = self._sight(c * dx + s * dy, c * dy - s * dx)
            radius_m = max(0.01, opponent.radius_m + self._s.opponent_radius_m * self._normal())
            if not self._lost(self._s.opponent_dropout) and seen is not None:
                at_x, at_y, *covariance = seen
                found.append(OpponentPercept(at_x, at_y, radius_m, *covariance))
        return OpponentPercepts(stamp_ns, tuple(found))

    def _sight(self, ahead: float, left: float) -> tuple[float, float, float, float, float] | None:
        """Measured place and its covariance (x, y, xx, yy, xy); None out of view. It draws in any case."""
        along, across = self._normal(), self._normal()
        distance, bearing = math.hypot(ahead, left), math.atan2(left, ahead)
        if not (self._s.ball_near_m < distance < self._s.ball_far_m and abs(bearing) < self._s.ball_half_view):
            return None
        sigma_along = self._s.ball_base_m + self._s.ball_share * distance
        sigma_across = 0.5 * sigma_along
        c, s = math.cos(bearing), math.sin(bearing)
        x = ahead + c * sigma_along * along - s * sigma_across * across
        y = left + s * sigma_along * along + c * sigma_across * across
        a, b = sigma_along**2, sigma_across**2
        return x, y, c * c * a + s * s * b, s * s * a + c * c * b, c * s * (a - b)
