"""Error models of the AGILO robot's sensors: encoders, and a camera that measures robot pose, ball and opponents.

Every random number comes from the generator of `Sensors.reset`. Metres, radians, seconds.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.schemas.messages.soccer import BallPercept, Opponent, OpponentPercept, OpponentPercepts

POSE_PERIOD_NS = 80_000_000
POSE_PERIOD_S = POSE_PERIOD_NS * 1e-9


@dataclass(frozen=True, slots=True)
class Sensing:
    """Parameters of the error models. Pose errors are correlated in time (AR(1)), as a camera repeats its mistakes."""

    pose_sigma_m: float = 0.045
    pose_sigma_rad: float = 0.04  # 2.3°
    pose_correlation_s: float = 0.6  # time constant
    pose_dropout: float = 0.03  # share of percepts lost
    ball_dropout: float = 0.03
    ball_base_m: float = 0.01
    ball_share: float = 0.05  # of the range, along the line of sight; half of it across
    ball_half_view: float = math.radians(50)
    ball_near_m: float = 0.25
    ball_far_m: float = 6.0
    opponent_dropout: float = 0.10  # found less often than a ball, and measured alike
    opponent_radius_m: float = 0.02
    encoder_scale: float = 0.01  # one draw a reset: tyre pressure
    encoder_v_mps: float = 0.008
    encoder_omega_radps: float = 0.015
    camera_delay_ns: int = 0  # a multiple of the firmware's period


class Sensors:
    """Converts true states to noisy messages."""

    def __init__(self, sensing: Sensing) -> None:
        self._s = sensing
        self._correlation = math.exp(-POSE_PERIOD_S / sensing.pose_correlation_s)
        self._innovation = math.sqrt(1.0 - self._correlation**2)
        self.reset(np.random.default_rng(0))

    def reset(self, rng: np.random.Generator) -> None:
        """Start anew with this source of noise; errors start in their stationary distribution."""
        self._normal = _normals(rng).__next__
        self._pose_error = [self._normal(), self._normal(), self._normal()]
        self._scale_v = 1.0 + self._s.encoder_scale * self._normal()
        self._scale_omega = 1.0 + self._s.encoder_scale * self._normal()
        self._odom = (0.0, 0.0, 0.0)

    def odometry(self, stamp_ns: int, v: float, omega: float, period_s: float) -> Odometry:
        """Velocities (m/s, rad/s) as the encoders measure them, and their integral since the reset."""
        v = v * self._scale_v + self._s.encoder_v_mps * self._normal()
        omega = omega * self._scale_omega + self._s.encoder_omega_radps * self._normal()
        x, y, phi = self._odom
        middle = phi + 0.5 * omega * period_s
        x += v * period_s * math.cos(middle)
        y += v * period_s * math.sin(middle)
        phi = math.remainder(phi + omega * period_s, math.tau)
        self._odom = (x, y, phi)
        return Odometry(stamp_ns, x, y, phi, v, omega)

    def pose(self, stamp_ns: int, x: float, y: float, phi: float) -> PoseEstimate | None:
        """Pose as the camera measures it; None if the percept is lost."""
        error = self._pose_error
        for axis in range(3):
            error[axis] = self._correlation * error[axis] + self._innovation * self._normal()
        if self._lost(self._s.pose_dropout):
            return None
        sigma, sigma_phi = self._s.pose_sigma_m, self._s.pose_sigma_rad
        phi = math.remainder(phi + sigma_phi * error[2], math.tau)
        x, y = x + sigma * error[0], y + sigma * error[1]
        return PoseEstimate(stamp_ns, x, y, phi, sigma**2, sigma**2, sigma_phi**2)

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

    def _lost(self, share: float) -> bool:
        return 0.5 * math.erfc(self._normal() / math.sqrt(2.0)) < share


def _normals(rng: np.random.Generator) -> Iterator[float]:
    """Standard normal numbers; drawn in blocks when they are needed, which is ten times faster."""
    while True:
        yield from reversed(rng.standard_normal(512).tolist())
