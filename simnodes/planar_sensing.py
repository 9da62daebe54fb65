"""Error models that every robot on wheels shares: odometry and a pose from a camera or another localiser.

A body's own sensors build on it. Every random number comes from the generator of `PlanarSensors.reset`. SI units.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tailor.schemas.messages import Odometry, PoseEstimate

MIN_VARIANCE = 1e-8  # of what is exact: filters divide by variances
POSE_PERIOD_NS = 80_000_000


@dataclass(frozen=True, slots=True)
class PlanarSensing:
    """Parameters of the error models. Pose errors are correlated in time (AR(1)), as a camera repeats its mistakes."""

    pose_sigma_m: float = 0.0
    pose_sigma_rad: float = 0.0
    pose_correlation_s: float = 0.6  # time constant
    pose_dropout: float = 0.0  # share of percepts lost
    odom_scale: float = 0.0  # one draw a reset: tyre pressure
    odom_v_mps: float = 0.0
    odom_omega_radps: float = 0.0


class PlanarSensors:
    """Converts the true velocity and pose of a base to noisy messages."""

    def __init__(self, sensing: PlanarSensing) -> None:
        self._planar = sensing
        self._correlation = math.exp(-POSE_PERIOD_NS * 1e-9 / sensing.pose_correlation_s)
        self._innovation = math.sqrt(1.0 - self._correlation**2)
        self.reset(np.random.default_rng(0))

    def reset(self, rng: np.random.Generator) -> None:
        """Start anew with this source of noise; errors start in their stationary distribution."""
        self._normal = _normals(rng).__next__
        self._pose_error = [self._normal() for _ in range(3)]
        self._scales = [1.0 + self._planar.odom_scale * self._normal() for _ in range(2)]
        self._odom = (0.0, 0.0, 0.0)

    def odometry(self, stamp_ns: int, v: float, omega: float, period_s: float) -> Odometry:
        """Velocities (m/s, rad/s) as the encoders measure them, and their integral since the reset."""
        v = v * self._scales[0] + self._planar.odom_v_mps * self._normal()
        omega = omega * self._scales[1] + self._planar.odom_omega_radps * self._normal()
        x, y, phi = self._odom
        middle = phi + 0.5 * omega * period_s
        x, y = x + v * period_s * math.cos(middle), y + v * period_s * math.sin(middle)
        phi = math.remainder(phi + omega * period_s, math.tau)
        self._odom = (x, y, phi)
        return Odometry(stamp_ns, x, y, phi, v, omega)

    def pose(self, stamp_ns: int, x: float, y: float, phi: float) -> PoseEstimate | None:
        """Pose (m, m, rad; map frame) as the localiser measures it; None if the percept is lost."""
        error, s = self._pose_error, self._planar
        for axis in range(3):
            error[axis] = self._correlation * error[axis] + self._innovation * self._normal()
        if self._lost(s.pose_dropout):
            return None
        x, y = x + s.pose_sigma_m * error[0], y + s.pose_sigma_m * error[1]
        phi = math.remainder(phi + s.pose_sigma_rad * error[2], math.tau)
        var, var_phi = max(MIN_VARIANCE, s.pose_sigma_m**2), max(MIN_VARIANCE, s.pose_sigma_rad**2)
        return PoseEstimate(stamp_ns, x, y, phi, var, var, var_phi)

    def _lost(self, share: float) -> bool:
        return 0.5 * math.erfc(self._normal() / math.sqrt(2.0)) < share


def _normals(rng: np.random.Generator) -> Iterator[float]:
    """Standard normal numbers; drawn in blocks when they are needed, which is ten times faster."""
    while True:
        yield from reversed(rng.standard_normal(512).tolist())
