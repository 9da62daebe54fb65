"""Cups in or under the hands of people who put robot and cups elsewhere during a run."""

from __future__ import annotations

import numpy as np
import pytest

from tailor.executive.belief.angles import difference
from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.simnodes.b21.profiles import body as of_profile
from tests.support.kitchen.b21_moves import OPEN_M, SHUT_M, cup, fetch, level_reach, seen_from, standing_at, with_cup

STILL = (0.0,) * 8
REACHED = dict(zip(JOINTS, level_reach(0.8, 0.1, 0.95), strict=True))


def rest(body, width=SHUT_M, seconds=1.0):
    body.command((*STILL, width))
    body.advance(round(seconds * 100) * 10_000_000)


@pytest.mark.parametrize("moved", [{"x": 1.0, "y": -0.5, "phi": 2.0}, REACHED, {"phi": -1.0, "v": 0.6, **REACHED}])
def test_a_robot_that_is_carried_elsewhere_keeps_its_cup(moved):
    """It was flung through the kitchen, or lay where the robot had been."""
    body = with_cup()
    rest(body, seconds=0.2)
    body.place(moved)
    rest(body)
    assert body.ground_truth().held == "cup1"
    angles = body.ground_truth().angles
    expected = with_cup(**dict(zip(JOINTS, angles, strict=True)))
    assert seen_from(body.ground_truth(), "cup1") == pytest.approx(seen_from(expected.ground_truth(), "cup1"), abs=0.01)
    rest(body, OPEN_M, 2.0)
    assert cup(body).z < 0.1


def test_a_cup_is_carried_as_it_was_gripped():
    body = of_profile()
    places = standing_at("table1", 0.6)
    body.reset(np.random.default_rng(0), {"cup1_x": -2.17, "cup1_y": 0.1, "cup1_phi": 1.0, **places})
    fetch(body, "cup1")
    before = cup(body).phi - body.ground_truth().phi
    body.place({"x": 0.5, "y": 0.0, "phi": 0.0})
    rest(body)
    assert body.ground_truth().held == "cup1"
    assert abs(difference(cup(body).phi, before)) < 0.05


@pytest.mark.parametrize("again", [1.0, 2.0])
def test_a_gripper_that_opens_holds_no_cup_that_was_in_it_before(again):
    """The first one hung in the air beside the hand from then on, whatever the gripper did."""
    body = with_cup()
    rest(body, seconds=0.2)
    body.place({"held": again})
    rest(body, OPEN_M, 2.0)
    assert all(each.z < 0.1 for each in body.ground_truth().objects if each.name.startswith("cup"))


def test_a_robot_whose_cup_is_taken_holds_none():
    body = with_cup()
    rest(body, seconds=0.2)
    body.place({"held": 0.0})
    rest(body)
    assert body.ground_truth().held == ""
    assert cup(body).z < 0.1


def test_a_cup_is_turned_where_it_stands():
    body = of_profile()
    body.reset(np.random.default_rng(0), {"cup1_x": -2.17, "cup1_y": 0.1, "cup1_phi": 1.0})
    rest(body, seconds=0.5)
    body.place({"cup1_phi": -2.0, "cup2_phi": 1.0})
    rest(body, seconds=0.5)
    assert [each.name for each in body.ground_truth().objects if each.name.startswith("cup")] == ["cup1"]
    assert (cup(body).x, cup(body).y, cup(body).phi) == pytest.approx((-2.17, 0.1, -2.0), abs=0.01)
