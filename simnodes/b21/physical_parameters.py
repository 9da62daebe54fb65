"""Physical parameters of the kitchen and its robot that are no sizes; sizes are in schemas/kitchen and b21.urdf."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Friction, motors and grip."""

    substeps: int = 1  # of the physics in a step of 10 ms
    iterations: int = 20  # of the contact solver; 50, PyBullet's default, takes twice as long and moves no cup by 1 mm
    floor_friction: float = 0.6
    table_friction: float = 0.5
    cup_friction: float = 0.7
    rolling_friction_m: float = 2e-3  # times the friction of the floor: a cup that has fallen rolls some decimetres
    bounce: float = 0.1
    drive_n: float = 500.0  # what the base pushes with at most
    turn_nm: float = 150.0
    joint_nm: tuple[float, ...] = (80.0, 120.0, 80.0, 40.0, 40.0, 40.0)
    grip_n: float = 30.0
    joint_gain: float = 0.1  # share of an angle's error that is closed in a step
    pressed_n: float = 1.0  # on both fingers: a cup is between them
    hold_n: float = 18.0  # a held cup breaks loose beyond it: some seven times its weight
