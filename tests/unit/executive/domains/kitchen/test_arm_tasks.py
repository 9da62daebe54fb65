"""What the arm does at a place, with joints that follow their commands and a gripper that closes at once."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.kitchen import places, robot
from tailor.executive.domains.kitchen.action_library import GRIP_CUP, PUT_CUP, REACH
from tailor.executive.domains.kitchen.arm_tasks import BACK_M, LIFTED_M, OVER_M, Hand
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.objects import Thing
from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.schemas.kitchen.kinematics import JOINT_MAX_RADPS, JOINTS

EXACT = (1e-8, 0.0, 0.0, 1e-8, 0.0, 1e-8)
SPOT = (0.75, 0.1)
CUP = Thing("cup1", *SPOT, kitchen().table.size[2] + kitchen().cup.height / 2, 0.0, 0.0, 1e-6, 1)
PERIOD_NS = 100_000_000


def arguments(action, spot=SPOT, aside=0.0):
    return np.array([0.0, 0.0, 0.0, *spot, aside, 0.0, 0.0][: len(action.parameters)])


def run(action, belief, spot=SPOT, aside=0.0, grasps=True, moved=None):
    """Beliefs of each tick and the last control; a gripper that is shut holds the cup if it grasps at all."""
    state, beliefs, arguments_now = None, [belief], arguments(action, spot, aside)
    for tick in range(400):
        control = action.controller(state, tick * PERIOD_NS, belief, arguments_now)
        if control.outcome != "running":
            return beliefs, control
        state, (*rates, width) = control.state, (*control.command, belief.width)[: len(JOINTS) + 1]
        assert max(map(abs, rates)) <= JOINT_MAX_RADPS
        angles = tuple(q + 0.1 * w for q, w in zip(belief.angles, rates, strict=True))
        held = "cup1" if grasps and width < 0.05 else ""
        things = belief.things if moved is None or tick < 5 else (replace(CUP, x=moved[0], y=moved[1]),)
        belief = replace(belief, angles=angles, velocities=tuple(rates), width=width, held=held, things=things)
        beliefs.append(belief)
    raise AssertionError("the task does not end")


def believed(**fields):
    return KitchenBelief(pose=Pose(0.0, 0.0, 0.0, EXACT), things=(CUP,), poses_seen=9, joints_ns=1, **fields)


def lowest(beliefs):
    hands = [robot.ARM.forward(belief.angles).place for belief in beliefs]
    return min(hands, key=lambda place: place[2])


def farthest_aside_when_low(beliefs, *wanted_y):
    """How far a hand that would push cups has been beside both places at which it may be low, m."""
    hands = [robot.ARM.forward(belief.angles).place for belief in beliefs if not belief.held]
    low = [y for _, y, z in hands if z < robot.GRASP_M + 0.03]
    return max(min(abs(y - wanted) for wanted in wanted_y) for y in low)


@pytest.mark.parametrize("aside", [-0.3, 0.0, 0.3])
def test_grip_closes_at_the_cup_and_comes_home(aside):
    beliefs, control = run(GRIP_CUP, believed(), aside=aside)
    assert control.outcome == "done"
    assert beliefs[-1].arm_is_home
    assert math.dist(lowest(beliefs), (*SPOT, robot.GRASP_M)) < 0.02


def test_grip_follows_a_cup_that_has_moved_a_little():
    beliefs, control = run(GRIP_CUP, believed(), moved=(0.70, 0.16))
    assert control.outcome == "done"
    assert math.dist(lowest(beliefs)[:2], (0.70, 0.16)) < 0.02


def test_grip_does_not_push_a_cup_aside_that_was_moved_as_the_hand_was_above_it():
    beliefs, control = run(GRIP_CUP, believed(), moved=(0.72, 0.20))
    assert control.outcome == "done"
    x, y, _ = lowest(beliefs)
    assert math.dist((x, y), (0.72, 0.20)) < 0.02
    assert farthest_aside_when_low(beliefs, y) < 0.03


def test_grip_comes_up_before_it_goes_to_a_cup_that_was_moved_from_between_its_fingers():
    low = Hand(0.0)(believed(), arguments(GRIP_CUP))
    away = (0.72, -0.10)
    begun = replace(believed(angles=low), things=(replace(CUP, x=away[0], y=away[1]),))
    beliefs, control = run(GRIP_CUP, begun, spot=away, moved=away)
    assert control.outcome == "done"
    assert math.dist(lowest(beliefs[20:])[:2], away) < 0.02
    assert farthest_aside_when_low(beliefs, SPOT[1], away[1]) < 0.03


def test_a_missed_cup_fails_with_the_arm_at_home():
    beliefs, control = run(GRIP_CUP, believed(), grasps=False)
    assert (control.outcome, control.detail) == ("failed", "missed the cup")
    assert beliefs[-1].arm_is_home


def test_what_is_out_of_reach_fails_before_the_arm_moves():
    beliefs, control = run(GRIP_CUP, believed(), spot=(1.6, 0.0), moved=None)
    assert (control.outcome, control.detail) == ("failed", "out of reach")
    assert len(beliefs) == 1


def test_a_cup_is_held_on_to_where_it_cannot_be_put():
    """The fingers were sent to where they touched it, and pressed it no more."""
    holding = believed(width=0.074, force=30.0, held="cup1")
    _, control = run(PUT_CUP, holding, spot=(1.6, 0.0))
    assert (control.outcome, control.detail) == ("failed", "out of reach")
    assert control.command[-1] == pytest.approx(0.074 - robot.PRESSED_M)


def test_put_opens_at_the_spot_and_comes_home():
    beliefs, control = run(PUT_CUP, believed(width=0.0, held="cup1"))
    assert control.outcome == "done"
    assert beliefs[-1].held == ""
    assert math.dist(lowest(beliefs), (*SPOT, robot.GRASP_M)) < 0.02


def test_reach_leaves_the_arm_above_the_spot():
    beliefs, control = run(REACH, believed())
    assert control.outcome == "done"
    x, y, z = robot.ARM.forward(beliefs[-1].angles).place
    assert z > robot.GRASP_M + 0.04
    assert math.dist((x, y), SPOT) < 0.2


def test_hand_stays_level_on_its_way():
    beliefs, _ = run(PUT_CUP, believed(width=0.0, held="cup1"))
    assert min(robot.ARM.forward(belief.angles).turn[2][2] for belief in beliefs) > math.cos(0.1)


def test_the_arm_reaches_a_displaced_cup_from_wherever_a_drive_ends_at_a_stand():
    """It did not from its farthest corners, looking aside: 1 of 130 random grips."""
    rng = np.random.default_rng(0)
    table = kitchen().tables["table1"]
    reached = 0
    for _ in range(1500):
        spot = places.Spot(table, *on_table(table, *(rng.uniform((0.19, 0.15), (0.27, 0.25)).tolist()))[:2])
        ranges = places.stand_ranges(spot)
        x, y, phi = (
            rng.uniform(ranges[q].lower - by, ranges[q].upper + by)
            for q, by in (("x", 0.04), ("y", 0.04), ("phi", 0.1))
        )
        given = np.array([x, y, phi, spot.x, spot.y, rng.uniform(-0.3, 0.3), 0.0, 0.0])
        belief = KitchenBelief(pose=Pose(x, y, phi, EXACT))
        hands = Hand(OVER_M, BACK_M), Hand(0.0), Hand(LIFTED_M)
        reached += all(hand(belief, given) is not None for hand in hands)
    assert reached >= 1499
