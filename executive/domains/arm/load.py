"""What the arm's motors bear: gravity, inertia and friction as its catalogue and one weighing give them."""

from __future__ import annotations

import math

Joints = tuple[float, ...]  # pan, lift

TORQUE_NM = 40.0  # rated torque of the gears: harmonic drive, size 20, ratio 160
ACCELERATION_RADPS2 = 2.5  # 1.9 m/s² at the pen; with more the base would sway
FOR_ACCELERATION = 0.5  # of the torque that gravity and friction leave; the rest is for passing bends, and feedback
ACCELERATION_MIN_RADPS2 = 0.8  # a cold gear that is lifted: beyond its rated torque, but far below the current limit
GRAVITY_NM, GRAVITY_AT_RAD = 25.9, 0.16  # about the lift, largest at this angle
ROTOR_KGM2, LINK_KGM2 = 0.34, 1.32  # of the stretched arm about either joint
COULOMB_NM, LOAD_FRICTION, VISCOUS_NMS = 4.0, 0.07, 5.0  # of a gear at 30 °C
TYPICAL_RADPS = 0.7  # largest speed of a middling reach
FULL_WAY_RAD = 0.2  # a joint that moves less far meets its friction in both directions
TRAINED_FRICTION = (0.6, 1.8)  # what models are asked for; gears between 10 and 70 °C have it
LEARNING_RADPS = 0.15  # slower joints reveal no friction


def accelerations(angles: Joints, goal: Joints, friction: Joints) -> Joints:
    """Acceleration (rad/s²) that each joint may plan with between two poses (rad): half of what its torque leaves.

    Args:
      angles: Where the arm is.
      goal: Where it goes.
      friction: Of each joint, as a multiple of the nominal; it slows a lift, and brakes a descent.
    """
    loads_nm = [max(values) for values in zip(_gravity(angles), _gravity(goal), strict=True)]
    planned = []
    for start, end, load_nm, factor, inertia in zip(angles, goal, loads_nm, friction, _inertia(goal), strict=True):
        direction = max(-1.0, min(1.0, (end - start) / FULL_WAY_RAD))
        left_nm = TORQUE_NM - load_nm - direction * factor * _friction(load_nm, TYPICAL_RADPS)
        possible = FOR_ACCELERATION * left_nm / inertia
        planned.append(max(ACCELERATION_MIN_RADPS2, min(ACCELERATION_RADPS2, possible)))
    return tuple(planned)


def observed_friction(
    angles: Joints, velocities: Joints, acceleration: Joints, efforts: Joints
) -> tuple[float | None, ...]:
    """Friction of each joint as a multiple of the nominal, from efforts (N·m); None where it hardly moves."""
    observed: list[float | None] = []
    rows = zip(_gravity(angles), _inertia(angles), velocities, acceleration, efforts, strict=True)
    for load_nm, inertia, velocity, change, effort_nm in rows:
        friction_nm = math.copysign(1.0, velocity) * (effort_nm - load_nm - inertia * change)
        moves = abs(velocity) > LEARNING_RADPS
        observed.append(friction_nm / _friction(load_nm, abs(velocity)) if moves else None)
    return tuple(observed)


def _gravity(angles: Joints) -> Joints:
    return 0.0, GRAVITY_NM * math.cos(angles[1] - GRAVITY_AT_RAD)


def _inertia(angles: Joints) -> Joints:
    """About the pan an arm that points up or down has less."""
    across = math.cos(angles[1] - GRAVITY_AT_RAD) ** 2
    return ROTOR_KGM2 + LINK_KGM2 * across, ROTOR_KGM2 + LINK_KGM2


def _friction(load_nm: float, speed_radps: float) -> float:
    return COULOMB_NM + LOAD_FRICTION * abs(load_nm) + VISCOUS_NMS * speed_radps
