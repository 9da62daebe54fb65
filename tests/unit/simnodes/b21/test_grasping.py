"""Cups: grasped by contact, held by a constraint that breaks, put down, tipped, dropped."""

import math

import numpy as np
import pytest

from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import HOME, JOINTS
from tailor.simnodes.b21.profiles import body as of_profile
from tests.support.kitchen.b21_moves import (
    OPEN_M,
    SHUT_M,
    cup,
    cups_on_tables,
    fetch,
    level_reach,
    move,
    seen_from,
    standing_at,
    straight,
    with_cup,
)


def at_table(away_m=0.6, **start):
    body = of_profile()
    body.reset(np.random.default_rng(0), {**cups_on_tables("cup1", "cup2"), **standing_at("table1", away_m), **start})
    return body


def rest(body, seconds=2.0, width=SHUT_M):
    body.command((0.0,) * 8 + (width,))
    return body.advance(round(seconds * 100) * 10_000_000)


@pytest.mark.parametrize("away_m", [0.4, 0.6, 0.8])
def test_a_cup_is_grasped_and_lifted_upright_from_anywhere_in_reach(away_m):
    body = at_table(away_m)
    readings = fetch(body, "cup1")
    assert body.ground_truth().held == "cup1"
    assert cup(body).z == pytest.approx(kitchen().table.size[2] + kitchen().cup.height / 2 + 0.1, abs=0.01)
    assert cup(body).tilt < 0.02
    assert not any(reading.message.touched for reading in readings if reading.topic == "kitchen_truth")
    gripper = [reading.message for reading in readings if reading.topic == "gripper"][-1]
    assert gripper.width == pytest.approx(2 * kitchen().cup.radius, abs=0.002)
    assert gripper.force > 10.0


def test_a_cup_is_put_down_and_stays_upright():
    body = at_table()
    x, y, z = seen_from(body.ground_truth(), "cup1")
    fetch(body, "cup1")
    low = z + kitchen().cup.grasp_height - kitchen().cup.height / 2 + 0.002
    straight(body, (x, y - 0.1, low + 0.05), SHUT_M, 2.0)
    straight(body, (x, y - 0.1, low), SHUT_M, 2.0)
    rest(body, 2.0, OPEN_M)
    assert body.ground_truth().held == ""
    assert (cup(body).z, cup(body).tilt) == pytest.approx((z, 0.0), abs=0.01)
    assert seen_from(body.ground_truth(), "cup1")[:2] == pytest.approx((x, y - 0.1), abs=0.015)


def test_a_closing_gripper_that_meets_nothing_holds_nothing():
    body = at_table()
    move(body, level_reach(0.8, 0.0, 0.95), SHUT_M, 3.0)
    rest(body)
    truth = body.ground_truth()
    assert (truth.held, truth.width) == ("", pytest.approx(0.0, abs=1e-3))


def test_a_gripper_that_closes_beside_a_cup_holds_nothing():
    body = at_table()
    x, y, z = seen_from(body.ground_truth(), "cup1")
    low = z + kitchen().cup.grasp_height - kitchen().cup.height / 2
    move(body, level_reach(x, y + 0.2, low + 0.1), OPEN_M, 4.0)
    straight(body, (x, y + 0.2, low), OPEN_M, 2.0)
    rest(body, 2.0)
    assert body.ground_truth().held == ""
    assert body.ground_truth().width < 0.01


def test_a_held_cup_follows_base_and_arm():
    body = with_cup(x=-1.0, y=0.0, phi=0.0)
    body.command((0.5, 0.0, *(0.0,) * 6, SHUT_M))
    body.advance(2_000_000_000)
    assert body.ground_truth().held == "cup1"
    x, _, z = seen_from(body.ground_truth(), "cup1")
    assert (x, z) == pytest.approx((0.58, 1.045), abs=0.01)
    assert cup(body).tilt < 0.05


def test_an_opening_gripper_drops_the_cup():
    body = with_cup(x=-1.0, y=0.5)
    rest(body, 2.0, OPEN_M)
    assert body.ground_truth().held == ""
    assert cup(body).z < 0.1


@pytest.mark.parametrize(("speed", "held"), [(0.3, "cup1"), (1.5, "")])
def test_a_hard_push_breaks_the_hold_and_a_soft_one_does_not(speed, held):
    body = with_cup(x=-1.0, y=0.5)
    rest(body, 0.5)
    body.place({"cup1_vx": 0.0, "cup1_vy": speed})
    rest(body)
    assert body.ground_truth().held == held
    assert (cup(body).z < 0.1) == (not held)


def test_furniture_breaks_the_hold():
    """A cup that the base pushes against the cupboard is lost."""
    body = with_cup(x=2.5, y=0.9, phi=math.pi / 2)
    body.command((0.4, 0.0, *(0.0,) * 6, SHUT_M))
    body.advance(2_500_000_000)
    assert body.ground_truth().held == ""


def test_a_slip_drops_the_cup_until_the_gripper_has_opened():
    body = with_cup(x=-1.0, y=0.5)
    rest(body, 0.5)
    body.place({"slip": 1.0})
    rest(body)
    assert body.ground_truth().held == ""
    assert cup(body).z < 0.1


def test_a_grasp_fails_on_purpose_and_the_next_one_succeeds():
    body = at_table()
    body.place({"fumble": 1.0})
    fetch(body, "cup1")
    assert body.ground_truth().held == ""
    assert cup(body).z < 0.8
    body = at_table()  # anew, but with the gripper opened after the failure
    body.place({"fumble": 1.0})
    x, y, z = seen_from(body.ground_truth(), "cup1")
    fetch(body, "cup1")
    move(body, level_reach(x, y, z + 0.25), OPEN_M, 2.0)
    assert cup(body).tilt < 0.1
    fetch(body, "cup1")
    assert body.ground_truth().held == "cup1"


def test_a_pushed_cup_tips_falls_and_comes_to_rest_on_the_floor():
    body = at_table()
    body.place({"cup1_vx": 2.0, "cup1_vy": 0.0})
    rest(body, 8.0)
    first = cup(body)
    assert first.z < 0.1
    assert first.tilt > kitchen().cup.tipped_rad
    rest(body, 1.0)
    assert math.hypot(cup(body).x - first.x, cup(body).y - first.y) < 0.02
    assert cup(body, "cup2").tilt < 0.01


def test_a_cup_is_placed_on_what_is_beneath_it():
    body = at_table(cup1_x=-0.6, cup1_y=1.9, cup2_x=0.0, cup2_y=0.0)
    assert cup(body, "cup1").z == pytest.approx(0.95, abs=1e-6)
    assert cup(body, "cup2").z == pytest.approx(0.05, abs=1e-6)


def test_a_cup_starts_in_the_gripper_of_any_arm():
    angles = level_reach(0.8, 0.1, 0.95)
    body = with_cup(**dict(zip(JOINTS, angles, strict=True)))
    rest(body, 0.5)
    assert seen_from(body.ground_truth(), "cup1")[:2] == pytest.approx((0.8, 0.1), abs=0.005)
    assert body.ground_truth().angles != pytest.approx(HOME)


@pytest.mark.parametrize(("held", "refused"), [(0.0, False), (1.0, False), (0.4, True), (99.0, True), (-1.0, True)])
def test_only_cups_that_there_are_can_be_held(held, refused):
    assert bool(of_profile("paper").refusal({"held": held})) is refused
