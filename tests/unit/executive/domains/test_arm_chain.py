"""Kinematics of a serial arm: forward, back, and what is out of reach."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.actions.chain import Chain, ChainJoint, HandPose, about, rotation_error

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
ARM = Chain(
    (
        ChainJoint((0.2, 0.0, 0.9), Z, -1.6, 1.6),
        ChainJoint((0.0, 0.0, 0.1), Y, -1.8, 1.8),
        ChainJoint((0.45, 0.0, 0.0), Y, -0.2, 2.7),
        ChainJoint((0.2, 0.0, 0.0), X, -3.1, 3.1),
        ChainJoint((0.2, 0.0, 0.0), Y, -1.9, 1.9),
        ChainJoint((0.08, 0.0, 0.0), X, -3.1, 3.1),
    ),
    (0.12, 0.0, 0.0),
)
HOME = (0.0, -1.0, 2.0, 0.0, -1.0, 0.0)
FAR = HandPose((3.0, 0.0, 1.0), about(Z, 0.0))


def test_stretched_arm_points_ahead() -> None:
    assert math.dist(ARM.forward((0.0,) * 6).place, (0.2 + 0.45 + 0.4 + 0.2, 0.0, 1.0)) < 1e-12


def test_first_joint_turns_all_about_its_axis() -> None:
    hand = ARM.forward((math.pi / 2, *(0.0,) * 5))
    assert math.dist(hand.place, (0.2, 1.05, 1.0)) < 1e-12
    assert math.dist(hand.turn[0], (0.0, 1.0, 0.0)) < 1e-12


@settings(max_examples=60, deadline=None)
@given(st.tuples(*[st.floats(-0.4, 0.4)] * 6))
def test_solution_brings_the_hand_to_its_pose(off: tuple[float, ...]) -> None:
    goal = ARM.forward(tuple(angle + by for angle, by in zip(HOME, off, strict=True)))
    angles = ARM.solve(goal, HOME)
    assert angles is not None
    found = ARM.forward(angles)
    assert math.dist(found.place, goal.place) < ARM.reached_m
    assert math.hypot(*rotation_error(found.turn, goal.turn)) < ARM.reached_rad
    assert all(j.lower <= angle <= j.upper for j, angle in zip(ARM.joints, angles, strict=True))


def test_out_of_reach_has_no_solution() -> None:
    assert ARM.solve(FAR, HOME) is None


def test_solution_keeps_to_the_ranges_of_joints() -> None:
    behind = ARM.forward((2.4, -1.0, 2.0, 0.0, -1.0, 0.0))  # the first joint turns by 1.6 at most
    found = ARM.solve(behind, HOME)
    assert found is None or abs(found[0]) <= 1.6


@pytest.mark.parametrize("axis", [X, Y, Z])
def test_hand_that_is_half_a_circle_off_has_not_reached_its_pose(axis: tuple[float, float, float]) -> None:
    hand = ARM.forward(HOME)
    turned = about(axis, math.pi)
    backwards = HandPose(hand.place, tuple(_composed(turned, column) for column in hand.turn))  # type: ignore[arg-type]
    assert math.hypot(*rotation_error(hand.turn, backwards.turn)) < ARM.reached_rad, "the sine sees no difference"
    found = ARM.solve(backwards, HOME)
    assert found is None or math.dist(sum(ARM.forward(found).turn, ()), sum(backwards.turn, ())) < 2 * ARM.reached_rad


def _composed(turn: tuple[tuple[float, float, float], ...], v: tuple[float, float, float]) -> tuple[float, ...]:
    """A vector, turned."""
    return tuple(sum(column[k] * part for column, part in zip(turn, v, strict=True)) for k in range(3))
