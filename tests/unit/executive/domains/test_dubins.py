"""Bounded-curvature paths end where they should and are the shortest of their kind."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.actions.dubins import shortest

coordinate = st.floats(-4, 4)
angle = st.floats(-math.pi, math.pi)
pose = st.tuples(coordinate, coordinate, angle)


def off(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1]) + abs(math.remainder(a[2] - b[2], math.tau))


@settings(max_examples=300, deadline=None)
@given(pose, pose, st.floats(0.3, 1.0))
def test_path_ends_at_the_goal_pose(start, goal, radius):
    path = shortest(start, goal, radius)
    assert off(path.at(path.length), goal) < 1e-6


@settings(max_examples=200, deadline=None)
@given(pose, pose, st.floats(0.3, 1.0))
def test_path_is_as_long_backwards(start, goal, radius):
    turned = tuple((x, y, phi + math.pi) for x, y, phi in (goal, start))
    forth, back = shortest(start, goal, radius), shortest(*turned, radius)
    assert forth.length == pytest.approx(back.length, abs=1e-6)


@settings(max_examples=200, deadline=None)
@given(pose, pose)
def test_wider_bends_never_make_a_far_path_shorter(start, goal):
    if math.dist(start[:2], goal[:2]) > 4.0:
        assert shortest(start, goal, 0.5).length <= shortest(start, goal, 0.9).length + 1e-9


@pytest.mark.parametrize(
    ("goal", "length"),
    [
        ((2.0, 0.0, 0.0), 2.0),
        ((0.0, 0.0, 0.0), 0.0),
        ((0.0, 1.0, math.pi), math.pi / 2),
        ((0.5, 0.5, math.pi / 2), math.pi / 4),
        ((0.5, -0.5, -math.pi / 2), math.pi / 4),
        ((0.0, 0.0, math.pi), 0.5 * 7 * math.pi / 3),  # turn round in three arcs
    ],
)
def test_known_paths_have_their_known_length(goal, length):
    assert shortest((0.0, 0.0, 0.0), goal, 0.5).length == pytest.approx(length, abs=1e-9)


def test_path_runs_in_and_out_straight():
    path = shortest((0.0, 0.0, 0.0), (1.0, 0.5, 0.7), 0.4)
    longer = path.between(0.1, 0.2)
    assert longer.length == pytest.approx(path.length + 0.3)
    assert longer.at(0.0)[:3] == pytest.approx((-0.1, 0.0, 0.0))
    assert longer.at(0.1 + path.length)[:3] == pytest.approx((1.0, 0.5, 0.7))


def test_path_goes_straight_on_beyond_its_end():
    assert shortest((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 0.5).at(2.0)[:3] == pytest.approx((2.0, 0.0, 0.0))
