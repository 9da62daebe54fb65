"""The kitchen is drawn where it is."""

import math

import numpy as np
import pytest

from tailor.robots import kitchen_scene as scene
from tailor.schemas.kitchen.kinematics import HOME, JOINTS, tool_pose
from tailor.schemas.messages.kitchen import KitchenObject, KitchenTruth
from tailor.schemas.packages.pose3 import on_plane
from tailor.schemas.packages.scene import on_map, pose_of

ANGLES = (0.3, 0.4, -1.6, 0.1, 1.2, -0.2)
TABLE = KitchenObject("table2", 2.3, -0.2, 0.72, 3.0, 0.0)
CUP = KitchenObject("cup1", 0.4, 0.3, 0.037, 1.0, math.pi / 2)
TRUTH = KitchenTruth(0, 0.5, -0.2, 0.7, 0.1, 0.0, 0.08, "", ANGLES, (), (TABLE, CUP))
BELIEF = {"x": 0.5, "y": -0.2, "phi": 0.7, "v": 0.1, "width": 0.08, **dict(zip(JOINTS, ANGLES, strict=True))}


@pytest.mark.parametrize("drawn", [scene.of_truth(TRUTH), scene.of_belief(BELIEF)])
def test_the_tool_is_where_the_arms_kinematics_have_it(drawn):
    expected = on_plane(0.5, -0.2, 0.7).then(tool_pose(ANGLES))
    tool = on_map(drawn.frames)["tool"]
    assert (tool.x, tool.y, tool.z, tool.qx) == pytest.approx((expected.x, expected.y, expected.z, expected.qx))


def test_believed_and_true_tables_are_drawn_alike():
    believed = scene.of_belief({**BELIEF, "table2_x": 2.3, "table2_y": -0.2, "table2_phi": 3.0})
    tables = [
        next(each for each in drawn.shapes if each.name == "table2") for drawn in (believed, scene.of_truth(TRUTH))
    ]
    assert tables[0] == tables[1]


def test_a_fallen_cup_lies():
    cup = pose_of(next(each for each in scene.of_truth(TRUTH).shapes if each.name == "cup1"))
    up = np.subtract(cup.moved((0.0, 0.0, 1.0)), cup.moved((0.0, 0.0, 0.0)))
    assert up[2] == pytest.approx(0.0, abs=1e-9)


def test_an_arm_that_was_not_sensed_is_drawn_at_home():
    tool = on_map(scene.of_belief({"x": 0.0, "y": 0.0, "phi": 0.0, "v": 0.0}).frames)["tool"]
    assert tool.z == pytest.approx(tool_pose(HOME).z)


def test_subgoals_are_drawn_where_the_robot_stands_and_where_its_hand_works():
    values = {"x": 1.0, "y": 0.0, "phi": 0.5, "spot_x": 2.0, "spot_y": 0.3}
    stand, spot = scene.of_subgoal(values), scene.of_target(values)
    assert (stand.x, stand.y, stand.yaw) == pytest.approx((1.0, 0.0, 0.5))
    assert (spot.x, spot.y) == (2.0, 0.3)
    assert scene.of_subgoal({"spot_x": 2.0, "spot_y": 0.3}) == spot
    assert scene.of_target({"x": 1.0, "y": 0.0}) is None
    assert scene.of_subgoal({"x": 1.0, "y": 0.0, "phi": 0.5}).yaw == pytest.approx(0.5)
    assert scene.of_subgoal({"aside": 0.1}) is None
