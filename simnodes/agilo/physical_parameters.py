"""Physical parameters that differ between robots of the AGILO type; the others are constants of scene.xml."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Parameters that scene.py sets in the model; the defaults are those of scene.xml."""

    timestep_s: float = 0.01  # a divisor of the body's step of 10 ms
    wheel_friction: float = 1.0
    servo_gain: float = 1.2  # of a wheel, N·m per rad/s
    rail_friction: float = 0.10
    ball_rolling_m: float = 0.0083  # lever of the ball's rolling resistance
