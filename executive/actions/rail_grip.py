"""Limits of turning and braking within which the ball stays in the robot's curved rail.

The rail can only push the ball, and only within an angle of straight ahead: beyond it the ball rolls out over the
rail's tip. The push accelerates the ball at the rail's bottom and overcomes the rolling resistance. Both are given as
accelerations.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RailGrip:
    """Geometry of the rail and rolling resistance of the ball."""

    in_rail_m: float  # axle to ball
    rolling_mps2: float  # by which the free ball slows down
    steepest_rad: float = 1.0  # angle of the push off straight ahead; the tips stand at 1.33, it slips out from 1.15 on

    def bend_mps(self, radius_m: float, push_rad: float) -> float:
        """Constant speed (m/s) in a bend at which the push points `push_rad` off straight ahead; >= 0."""
        curvature, slope = 1.0 / radius_m, math.tan(push_rad)
        across = self.in_rail_m * curvature  # speed of the ball across, relative to ahead
        resistance = self.rolling_mps2 / math.hypot(1.0, across)
        return math.sqrt(max(0.0, resistance * (slope - across) / (curvature * (1.0 + slope * across))))

    def braking_mps2(self, v: float, omega: float) -> float:
        """Maximum braking (m/s²) at v (m/s) and omega (rad/s), neither changing direction; >= 0."""
        ahead, aside = self._push(v, omega)
        return max(0.0, ahead - abs(aside) / math.tan(self.steepest_rad))

    def yaw_radps2(self, v: float, omega: float, braking_mps2: float) -> float:
        """Maximum growth of |omega| (rad/s²) while the robot brakes; >= 0."""
        ahead, aside = self._push(v, omega)
        return max(0.0, ((ahead - braking_mps2) * math.tan(self.steepest_rad) - abs(aside)) / self.in_rail_m)

    def _push(self, v: float, omega: float) -> tuple[float, float]:
        """Push that holds the ball at constant v and omega: m/s² ahead and to the left."""
        sideways = omega * self.in_rail_m
        speed = math.hypot(v, sideways)
        resistance = self.rolling_mps2 / speed if speed > 0.0 else 0.0
        return resistance * v - omega * sideways, resistance * sideways + v * omega
