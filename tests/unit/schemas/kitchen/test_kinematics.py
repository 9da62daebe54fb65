"""The arm's chain, against geometry that needs no chain."""

import math

import pytest

from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.schemas.kitchen.kinematics import (
    ARM,
    FOREARM_M,
    HAND_M,
    HOME,
    SHOULDER,
    UPPER_ARM_M,
    VIEW_M,
    joint_frames,
    tool_pose,
)


def test_a_stretched_arm_points_ahead():
    tool = tool_pose((0.0,) * 6)
    assert (tool.x, tool.y, tool.z) == pytest.approx((SHOULDER[0] + UPPER_ARM_M + FOREARM_M + HAND_M, 0.0, SHOULDER[2]))


def test_positive_angles_lift_and_turn_left():
    assert tool_pose((0.0, math.pi / 2, 0.0, 0.0, 0.0, 0.0)).z == pytest.approx(SHOULDER[2] + 0.9)
    assert tool_pose((math.pi / 2, 0.0, 0.0, 0.0, 0.0, 0.0)).y == pytest.approx(0.9)


def test_home_is_level_above_every_table_and_within_the_limits():
    tool = tool_pose(HOME)
    assert (tool.qx, tool.qy, tool.qz) == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)
    assert tool.z > max(box.size[2] for name, box in kitchen().fixed.items() if name == "counter")
    assert all(joint.lower < angle < joint.upper for joint, angle in zip(ARM, HOME, strict=True))
    assert all(frame.z > kitchen().table.size[2] for frame in joint_frames(HOME))


def test_cups_lie_in_reach_of_a_robot_at_0_4_to_0_8_m_from_the_table():
    cup, table = kitchen().cup, kitchen().table
    height = table.size[2] + cup.grasp_height - SHOULDER[2]
    for slot_x, slot_y in table.slots:
        inside = kitchen().edge_m - slot_x
        for away in (0.4, 0.8):
            across = math.hypot(away + inside - SHOULDER[0], slot_y) - HAND_M
            assert abs(UPPER_ARM_M - FOREARM_M) < math.hypot(across, height) < UPPER_ARM_M + FOREARM_M
            assert VIEW_M[0] < away + inside


def test_a_place_on_a_table_turns_with_it():
    assert on_table((1.0, 2.0, math.pi / 2), 0.3, 0.1, 0.2) == pytest.approx((0.9, 2.3, math.pi / 2 + 0.2))
