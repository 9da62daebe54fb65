"""What the arm does at a place: reach over it, grip the cup that stands there, put it down, and come home.

Arguments: the stand (x, y, phi), the cup's spot (x, y), how far the hand comes from aside, whether the arm is out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.actions.arm_task import ArmTask, Stretch
from tailor.executive.actions.chain import HandPose
from tailor.executive.actions.cubic import Joints
from tailor.executive.actions.reach import Reach
from tailor.executive.domains.kitchen import objects, robot
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.kinematics import GRIPPER_MAX_M, JOINT_MAX_RADPS

X, Y, PHI, SPOT_X, SPOT_Y, ASIDE, OUT, HANDLE = range(8)
BACK_M = (0.12, 0.08, 0.04, 0.0)  # behind the cup where the hand comes down, as far as the arm folds
OVER_M = 0.07  # above the cup's grasp height
CLEAR_M = OVER_M - 0.03  # a hand that is lower pushes cups aside on its way
LIFTED_M = 0.10
CLOSED_S, OPENED_S = 0.9, 0.7  # until the gripper has closed on a cup, or opened
SAME_CUP_M = 0.12  # a cup so near the spot is the one to grip
OFF_M, BESIDE_RAD = 0.045, 0.04  # a hand that comes down from farther beside its place, or aside of it, pushes the cup
SHUT, WIDE = 0.0, GRIPPER_MAX_M

ACCELERATION_RADPS2 = 1.1  # of a stretch from rest to rest, over all joints
MAX_RADPS2, MAX_RADPS = 2.5, 1.0  # what no stretch exceeds


def _accelerations(now: Joints, goal: Joints, friction: Joints) -> Joints:
    return (ACCELERATION_RADPS2,) * len(now)


REACH = Reach(
    _accelerations,
    MAX_RADPS2,
    MAX_RADPS,
    feedback_per_s=4.0,
    reached_rad=0.02,
    reached_radps=0.15,
    at_once=True,
)


@dataclass(frozen=True, slots=True)
class Hand:
    """A level hand at a spot: `up_m` above the grasp height, behind it by the first of `back_m` that the arm reaches.

    `live`: the spot is that of the cup which stands there, as it is believed now.
    """

    up_m: float
    back_m: tuple[float, ...] = (0.0,)
    live: bool = False

    def __call__(self, belief: KitchenBelief, arguments: Array) -> Joints | None:
        """Joint angles, rad; None if the hand does not get there."""
        x, y = float(arguments[SPOT_X]), float(arguments[SPOT_Y])
        place = belief.in_base(*((_cup_at(belief, x, y) if self.live else None) or (x, y)))
        for back_m in self.back_m:
            hand = robot.level_hand(*place, robot.GRASP_M + self.up_m, float(arguments[ASIDE]), back_m)
            angles = robot.angles_for(hand)
            if angles is not None:
                return angles
        return None


def _cup_at(belief: KitchenBelief, x: float, y: float) -> tuple[float, float] | None:
    """The cup at a spot, as it was seen; None if none was: it may be where the map has one."""
    cups = (cup for cup in objects.cups(belief.things) if cup.name != belief.held)
    near = min(((math.hypot(cup.x - x, cup.y - y), cup.x, cup.y) for cup in cups), default=(math.inf, x, y))
    return near[1:] if near[0] < SAME_CUP_M else None


OVER_CUP = Hand(OVER_M, BACK_M, live=True)


def _above(belief: KitchenBelief, arguments: Array) -> Joints | None:
    """Over the cup; first straight up from where the hand is low, as after a grip at which the cup was moved away."""
    over, now = OVER_CUP(belief, arguments), robot.ARM.forward(belief.angles)
    (x, y, z), clear = now.place, robot.GRASP_M + CLEAR_M
    if over is None or z > clear:
        return over
    return robot.ARM.solve(HandPose((x, y, robot.GRASP_M + OVER_M), now.turn), belief.angles) or over


def _is_elsewhere(belief: KitchenBelief, arguments: Array, reached: Joints) -> bool:
    """Whether the hand is not over the cup: it has come up beside it, or the cup was moved meanwhile."""
    over = OVER_CUP(belief, arguments)
    if over is None:
        return False
    off_m = math.dist(robot.ARM.forward(over).place, robot.ARM.forward(reached).place)
    return off_m > OFF_M or abs(over[0] - reached[0]) > BESIDE_RAD


def _home(belief: KitchenBelief, arguments: Array) -> Joints:
    return robot.HOME


def _unseen(belief: KitchenBelief, arguments: Array) -> str:
    seen = _cup_at(belief, float(arguments[SPOT_X]), float(arguments[SPOT_Y]))
    return "no cup seen there" if seen is None else ""


def _missed(belief: KitchenBelief) -> str:
    return "" if belief.held else "missed the cup"


def _lost(belief: KitchenBelief) -> str:
    return "" if belief.held else "lost the cup"


def _kept(belief: KitchenBelief) -> str:
    return "still holds the cup" if belief.held else ""


def _kept_width(belief: KitchenBelief) -> float:
    return robot.kept_width(belief.width, belief.force)


REACH_SPOT = ArmTask(REACH, (Stretch(Hand(OVER_M, BACK_M)),), JOINT_MAX_RADPS, homing=False)
FOLD = ArmTask(REACH, (Stretch(_home),), JOINT_MAX_RADPS)
GRIP = ArmTask(
    REACH,
    (
        Stretch(_above, WIDE, goes_on=_is_elsewhere),
        Stretch(Hand(0.0, live=True), WIDE),
        Stretch(None, SHUT, CLOSED_S, _missed),
        Stretch(Hand(LIFTED_M), SHUT),
        Stretch(_home, SHUT, failed=_lost),
    ),
    JOINT_MAX_RADPS,
    refused=_unseen,
    kept=_kept_width,
)
PUT = ArmTask(
    REACH,
    (
        Stretch(Hand(OVER_M), SHUT, failed=_lost),
        Stretch(Hand(0.003), SHUT),
        Stretch(None, WIDE, OPENED_S, _kept),
        Stretch(Hand(0.02, BACK_M), WIDE),
        Stretch(_home, WIDE),
    ),
    JOINT_MAX_RADPS,
    kept=_kept_width,
)
