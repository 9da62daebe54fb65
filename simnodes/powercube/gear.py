"""Gear of one joint: friction by temperature and load, heat, and backlash between motor and link."""

from __future__ import annotations

import math

import numpy as np

from tailor.simnodes.powercube.physical_parameters import PhysicalParameters

NOMINAL_C = 30.0  # at which scene.xml states friction


class Gear:
    """State of a gear: its temperature (°C), and how far the motor is ahead of the link (rad)."""

    def __init__(self, parameters: PhysicalParameters, coulomb_nm: float, viscous_nms: float) -> None:
        """Friction at 30 °C without load, N·m and N·m·s/rad."""
        self._p = parameters
        self._nominal = coulomb_nm, viscous_nms
        self.half_gap_rad = 0.5 * parameters.backlash_rad
        self.temperature_c, self._factor, self.ahead_rad = NOMINAL_C, 1.0, 0.0

    def reset(self, rng: np.random.Generator) -> None:
        """Draw temperature, wear, and where in the backlash the motor stands."""
        p = self._p
        self.temperature_c = float(rng.uniform(*p.temperature_c))
        self._factor = float(np.clip(1.0 + p.friction_std * rng.standard_normal(), 0.5, 1.5))
        self.ahead_rad = self.half_gap_rad * float(rng.uniform(-1.0, 1.0))

    def preload(self, torque_nm: float) -> None:
        """Let a torque that has long pushed the link close the backlash; no torque leaves it."""
        if torque_nm:
            self.ahead_rad = math.copysign(self.half_gap_rad, torque_nm)

    def friction(self, load_nm: float) -> tuple[float, float]:
        """Coulomb (N·m) and viscous friction (N·m·s/rad) under a load."""
        coulomb_nm, viscous_nms = self._nominal
        thinner = math.exp((NOMINAL_C - self.temperature_c) / self._p.viscosity_fall_k)
        dry_nm = coulomb_nm + self._p.load_friction * abs(load_nm)
        return self._factor * dry_nm, self._factor * thinner * viscous_nms

    def heat(self, loss_w: float, duration_s: float) -> None:
        """Warm with the losses of motor and gear, and cool towards the room."""
        p = self._p
        cooling_w = p.cooling_wpk * (self.temperature_c - p.ambient_c)
        self.temperature_c += (loss_w - cooling_w) * duration_s / p.heat_capacity_jpk
