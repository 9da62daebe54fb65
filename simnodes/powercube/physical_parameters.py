"""What the PowerCube arm is: its modules, motors and gears. Metres, kilograms, radians, amperes, newton metres.

Six rotary modules in a row on a mobile robot's top (paper Figure 3(c)). Two move, four are held by their brakes.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Module:
    """One rotary module and the link behind it."""

    name: str
    axis: tuple[int, int, int]  # in its own frame, x along the arm, z up
    length_m: float  # to the next module
    mass_kg: float  # of the module itself
    radius_m: float
    rest_rad: float = 0.0  # where a braked module stands


# pan turns positive to the right and lift positive upward, so that letters written in (pan, lift) read as such
MODULES = (
    Module("pan", (0, 0, -1), 0.0, 3.4, 0.055),
    Module("lift", (0, -1, 0), 0.22, 3.4, 0.055),
    Module("elbow", (0, -1, 0), 0.20, 1.7, 0.045, rest_rad=-0.35),
    Module("forearm", (1, 0, 0), 0.16, 1.7, 0.045),
    Module("wrist", (0, -1, 0), 0.08, 1.0, 0.035, rest_rad=0.35),
    Module("hand", (1, 0, 0), 0.12, 0.8, 0.035),
)
WRITING = ("pan", "lift")  # the two that move
NAMES = tuple(module.name for module in MODULES)


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Motors and gears of the two writing modules; catalogue sizes of PR 70 to PR 90, rounded."""

    shoulder_height_m: float = 1.25
    pen_kg: float = 0.15
    link_kg_per_m: float = 1.2
    gear: float = 161.0
    torque_nm_per_a: float = 6.5  # at the joint: 0.062 N·m/A times the gear, two thirds efficient
    rotor_kgm2: float = 1.3e-5
    current_max_a: float = 12.0
    encoder_counts: int = 2000  # a turn of the motor: 2e-5 rad at the joint
    coulomb_nm: float = 4.0
    viscous_nms: float = 3.0
    velocity_max_radps: float = 1.2
    acceleration_max_radps2: float = 5.0
    position_max_rad: float = 2.0
    brake_nm_per_rad: float = 6000.0  # a braked module gives a little
    friction_spread: float = 0.10  # one draw a reset: how warm the grease is
    torque_spread: float = 0.02  # one draw a reset: how warm the magnets are

    @property
    def count_rad(self) -> float:
        """The joint angle of one encoder count."""
        return 2 * 3.141592653589793 / (self.encoder_counts * self.gear)
