"""From when on nobody knows where the robot is: the localiser says so itself, or has been silent for too long. Pure."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Doubt:
    """Standard deviations of a pose up to which a robot is driven by it."""

    max_std_m: float = math.inf
    max_std_rad: float = math.inf

    def exceeded(self, var_x: float, var_y: float, var_phi: float) -> str:
        """Which of them a pose with these variances exceeds, as text; empty: none."""
        std_m, std_rad = math.sqrt(max(var_x, var_y)), math.sqrt(var_phi)
        if std_m > self.max_std_m:
            return f"standard deviation of {std_m:.2f} m, beyond pose.max_std_m = {self.max_std_m:g}"
        if std_rad > self.max_std_rad:
            return f"standard deviation of {std_rad:.2f} rad, beyond pose.max_std_rad = {self.max_std_rad:g}"
        return ""
