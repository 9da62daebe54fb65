"""What the AGILO robot and its ball are: sizes, masses, friction. Metres, kilograms, seconds, radians.

A customised Pioneer I with a curved guide rail in front that cradles the ball (paper 4.2).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PhysicalParameters:
    """Robot, rail and ball. The origin of the robot is the middle of its axle, x ahead."""

    wheel_radius_m: float = 0.0625
    track_m: float = 0.30
    wheel_mass_kg: float = 0.5
    chassis_mass_kg: float = 14.0
    chassis_length_m: float = 0.41
    chassis_width_m: float = 0.32
    chassis_height_m: float = 0.16
    chassis_ahead_m: float = -0.025  # centre of the box; its front stays behind the rail
    mass_ahead_m: float = -0.035  # centre of mass: behind the axle, so that the caster carries load
    mass_above_m: float = 0.05
    caster_ahead_m: float = -0.17
    servo_gain: float = 1.2  # N·m per rad/s at the wheel: follows a step within about 30 ms
    servo_torque_nm: float = 2.5
    wheel_friction: float = 1.0
    rail_ahead_m: float = 0.20  # the deepest point of the arc
    rail_radius_m: float = 0.118
    rail_half_angle: float = 1.3265  # ±76°: the rail is 8.9 cm deep
    rail_segments: int = 9  # chords stay within 1.3 mm of the arc
    rail_thickness_m: float = 0.005
    rail_friction: float = 0.10  # polished: the ball rolls on the floor and slides along the rail
    ball_radius_m: float = 0.11
    ball_mass_kg: float = 0.45
    ball_friction: float = 0.5
    ball_rolling_m: float = 0.0083  # lever of the rolling resistance: the free ball slows by 0.53 m/s²


def ball_in_rail_m(physical_parameters: PhysicalParameters) -> float:
    """Distance from the axle to the centre of a ball that lies in the rail."""
    return physical_parameters.rail_ahead_m + physical_parameters.ball_radius_m
