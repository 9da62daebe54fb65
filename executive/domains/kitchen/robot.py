"""The B21 as its actions see it: its arm as a chain of joints, and how it holds a cup."""

from __future__ import annotations

import math

from tailor.executive.actions.chain import Chain, ChainJoint, HandPose, about
from tailor.executive.actions.cubic import Joints
from tailor.schemas.kitchen import kinematics
from tailor.schemas.kitchen.furniture import kitchen

HOME: Joints = kinematics.HOME
HOME_RAD = 0.12  # joints that are all so near home: the robot may drive
HELD_N = 2.0  # force from which it holds something
PRESSED_N = 10.0  # force from which it presses something: a third of its grip, far beyond the noise of an empty one
PRESSED_M = 0.004  # set-point below the width of that: so far the firmware lets it run ahead
CUP_M = 2 * kitchen().cup.radius
# width of a gripper that has a cup between its fingers: from where they slip off its side to across its handle
HELD_M = (0.04, CUP_M + kitchen().cup.handle[0] + 0.006)
GRASP_M = kitchen().table.size[2] + kitchen().cup.grasp_height  # height of the hand at a cup that stands
AHEAD_M, _, SHOULDER_M = kinematics.SHOULDER
UP = (0.0, 0.0, 1.0)

_first, *_others = kinematics.ARM
ARM = Chain(
    (
        ChainJoint(kinematics.SHOULDER, _first.axis, _first.lower, _first.upper),
        *(ChainJoint((joint.ahead_m, 0.0, 0.0), joint.axis, joint.lower, joint.upper) for joint in _others),
    ),
    (kinematics.TOOL_M, 0.0, 0.0),
)


def kept_width(width: float, force: float) -> float:
    """Set-point (m) at which a gripper of a width (m) stays as it is, and goes on pressing what it presses (N)."""
    return max(0.0, width - (PRESSED_M if force > PRESSED_N else 0.0))


def level_hand(ahead: float, left: float, z: float, aside: float, back: float = 0.0) -> HandPose:
    """A level hand at a place in base_link (m), `back` metres behind it.

    It points away from the shoulder, turned aside (rad, to the left).
    """
    heading = math.atan2(left, ahead - AHEAD_M) + aside
    c, s = math.cos(heading), math.sin(heading)
    return HandPose((ahead - back * c, left - back * s, z), about(UP, heading))


def angles_for(hand: HandPose) -> Joints | None:
    """Angles that bring a level hand to its pose, with the elbow up; None if it is out of reach."""
    seed = _elbow_up(hand)
    return None if seed is None else ARM.solve(hand, seed)


def _elbow_up(hand: HandPose) -> Joints | None:
    """Closed form for a level hand, but for the roll of forearm and hand."""
    (x, y, z), (c, s, _) = hand.place, hand.turn[0]
    x, y, z = x - AHEAD_M - kinematics.HAND_M * c, y - kinematics.HAND_M * s, z - SHOULDER_M
    upper, fore, far = kinematics.UPPER_ARM_M, kinematics.FOREARM_M, math.hypot(x, y, z)
    if not abs(upper - fore) < far < upper + fore:
        return None
    elbow = -math.acos((far * far - upper * upper - fore * fore) / (2 * upper * fore))
    at_shoulder = math.acos((upper * upper + far * far - fore * fore) / (2 * upper * far))
    lift = math.atan2(z, math.hypot(x, y)) + at_shoulder
    return (math.atan2(y, x), lift, elbow, 0.0, -lift - elbow, 0.0)
