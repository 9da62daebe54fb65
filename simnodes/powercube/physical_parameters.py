"""Motors and gears of the PowerCube arm; scene.xml holds masses, sizes and friction."""

from __future__ import annotations

import math
from dataclasses import dataclass

NAMES = ("pan", "lift", "elbow", "forearm", "wrist", "hand")  # joints, from the shoulder outward
WRITING = ("pan", "lift")  # the two joints that move


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Motors and gears of the two writing modules; catalogue sizes of PR 70 to PR 90, rounded."""

    gear: float = 161.0
    torque_nm_per_a: float = 6.5  # at the joint: 0.062 N·m/A times the gear, two thirds efficient
    current_max_a: float = 12.0
    encoder_counts: int = 2000  # per turn of the motor: 2e-5 rad at the joint
    velocity_max_radps: float = 1.2
    acceleration_max_radps2: float = 5.0
    position_max_rad: float = 2.0
    friction_std: float = 0.10  # relative, one draw a reset: temperature of the grease
    torque_std: float = 0.02  # relative, one draw a reset: temperature of the magnets

    @property
    def count_rad(self) -> float:
        """The joint angle of one encoder count."""
        return 2 * math.pi / (self.encoder_counts * self.gear)
