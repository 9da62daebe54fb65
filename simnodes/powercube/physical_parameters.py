"""Motors, gears and sensors of the PowerCube arm; scene.xml holds masses, sizes and friction at 30 °C."""

from __future__ import annotations

import math
from dataclasses import dataclass

NAMES = ("pan", "lift", "elbow", "forearm", "wrist", "hand")  # joints, from the shoulder outward
WRITING = ("pan", "lift")  # the two joints that move


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Motors and gears of the two writing modules; catalogue sizes of PR 70 to PR 90, rounded.

    Friction by load and temperature has the form of Bittencourt and Gunnarsson, "Static Friction in a Robot Joint:
    Modeling and Identification of Load and Temperature Effects", J. Dyn. Sys. Meas. Control 134(5), 2012. Its size is
    about that of a harmonic drive of size 20, which is some 55, 70, 77 % efficient at 0, 20, 40 °C; see also Wolf and
    Iskandar, "Extending a Dynamic Friction Model with Nonlinear Viscous and Thermal Dependency for a Motor and Harmonic
    Drive Gear", ICRA 2018.
    """

    gear: float = 161.0
    torque_nm_per_a: float = 6.5  # at the joint: 0.062 N·m/A times the gear, two thirds efficient
    current_max_a: float = 12.0
    encoder_counts: int = 2000  # per turn of the motor: 2e-5 rad at the joint
    velocity_max_radps: float = 1.2
    acceleration_max_radps2: float = 5.0
    position_max_rad: float = 2.0
    torque_std: float = 0.02  # relative, one draw a reset: temperature of the magnets

    friction_std: float = 0.10  # relative, one draw a reset: mounting and wear
    load_friction: float = 0.07  # Coulomb friction for each N·m that the gear carries
    viscosity_fall_k: float = 20.0  # viscous friction falls by a factor of e over so many kelvins
    temperature_c: tuple[float, float] = (15.0, 45.0)  # uniform, one draw a reset: a cool morning, to an hour's work
    ambient_c: float = 20.0
    heat_capacity_jpk: float = 1200.0  # 1.5 kg of steel and aluminium about the gear
    cooling_wpk: float = 0.8  # through housing and flanges: cools with a time constant of 25 minutes
    winding_ohm: float = 0.6

    backlash_rad: float = 6e-4  # from end to end, 2 arc minutes: keyways and couplings; the wave gear has none
    film_nms: float = 100.0  # what slows the motor down across the backlash: grease

    encoder_std_rad: float = 2e-4  # kinematic error of a wave gear, about 1 arc minute from peak to peak
    read_jitter_s: float = 0.001  # the bus polls the modules one after another; one stamp for all
    tacho_std_radps: float = 0.01  # of velocities from counts over some milliseconds
    current_std_a: float = 0.1

    @property
    def count_rad(self) -> float:
        """The joint angle of one encoder count."""
        return 2 * math.pi / (self.encoder_counts * self.gear)
