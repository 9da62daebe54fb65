"""Mechanical work of a robot's drives between two of its 10 Hz states: the target of energy models (paper 8).

Braking recovers nothing. Heat in the motors and the consumption of electronics are not included.
"""

from __future__ import annotations

import math

from tailor.schemas.messages import JointState, Message, Odometry
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.simnodes.agilo import dimensions as agilo

WHEELS = 2
# equivalent mass of the spinning wheels (an ellipsoid's inertia, 2/5 m r²) and their motors
SPINNING_KG = WHEELS * (0.4 * agilo.WHEEL_MASS_KG + agilo.WHEEL_ARMATURE_KGM2 / agilo.WHEEL_RADIUS_M**2)
MASS_KG = agilo.CHASSIS_MASS_KG + WHEELS * agilo.WHEEL_MASS_KG + SPINNING_KG
YAW_KGM2 = (
    agilo.CHASSIS_MASS_KG * ((agilo.CHASSIS_LENGTH_M**2 + agilo.CHASSIS_WIDTH_M**2) / 12 + agilo.MASS_AHEAD_M**2)
    + (WHEELS * agilo.WHEEL_MASS_KG + SPINNING_KG) * (agilo.TRACK_M / 2) ** 2
)


def wheel_work_j(before: Message, after: Message) -> float:
    """Work of AGILO's wheels between two states: the increase of its kinetic energy, never negative.

    Its simulated wheels roll without friction. The force of a pushed ball (0.2 N) is not included.

    Args:
      before, after: `SoccerGroundTruth`, or `Odometry` without ground truth (its noise adds about 0.5 W).

    Returns:
      Joules; NaN for other messages.
    """
    if not isinstance(before, SoccerGroundTruth | Odometry) or not isinstance(after, SoccerGroundTruth | Odometry):
        return math.nan
    gained = after.v**2 - before.v**2, after.omega**2 - before.omega**2
    return max(0.0, 0.5 * MASS_KG * gained[0] + 0.5 * YAW_KGM2 * gained[1])


def joint_work_j(before: Message, after: Message) -> float:
    """Work of an arm's motors between two states: the positive power of each joint, integrated over time.

    Returns:
      Joules; NaN for messages other than joint states with efforts.
    """
    if not isinstance(before, JointState) or not isinstance(after, JointState):
        return math.nan
    if not (before.efforts and after.efforts):
        return math.nan
    return 0.5 * (_power_w(before) + _power_w(after)) * 1e-9 * (after.stamp_ns - before.stamp_ns)


def _power_w(state: JointState) -> float:
    return sum(max(0.0, nm * radps) for nm, radps in zip(state.efforts, state.velocities, strict=True))
