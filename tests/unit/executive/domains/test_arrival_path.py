"""Ways into a goal: they begin at the robot, end on the goal's line along its heading, bend little."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tailor.executive import domains
from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.domains.soccer.subgoal_risk import BallContactRisk

WAYS = ArrivalPath(v_max_mps=0.9)
places = st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), st.floats(-math.pi, math.pi))
speeds = st.floats(0.0, 0.6)


@given(places, speeds)
def test_way_leads_from_the_robot_to_the_goal_along_its_heading(start, vg):
    # nearer the goal than the tightest bend none may fit
    assume(math.hypot(start[0] + WAYS.run_in_m, start[1]) > 2.0 * WAYS.tightest_m / WAYS.inside)
    path = WAYS.quickest(start, vg)
    aside = abs(path.start[1] - start[1])
    assert path.start[0] == pytest.approx(start[0])
    assert aside < 1e-9 or (path.start[1:] == (0.0, 0.0) and aside < 0.12), "else along the goal's line"
    x, y, heading, _ = path.at(path.length)
    assert (x, y, math.remainder(heading, math.tau)) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


@given(places, speeds)
def test_bend_is_never_wider_than_requested_and_never_a_full_circle(start, vg):
    assume(math.hypot(start[0] + WAYS.run_in_m, start[1]) > 2.0 * WAYS.tightest_m / WAYS.inside)
    path = WAYS.quickest(start, vg)
    assert WAYS.tightest_m <= path.radius <= WAYS.radius(vg)
    assert path.pieces[1][1] <= 1.8 * math.pi * path.radius


@pytest.mark.parametrize("x", [-0.05, -0.15])
def test_right_before_the_goal_a_few_centimetres_aside_are_left_uncorrected(x):
    path = WAYS.quickest((x, 0.04, 0.1), 0.2)
    assert path.start == (x, 0.0, 0.0)
    assert path.at(path.length)[:3] == (0.0, 0.0, 0.0)


def test_faster_goals_are_met_in_wider_bends():
    assert WAYS.radius(0.0) == WAYS.radius(0.3) < WAYS.radius(0.6)
    assert WAYS.radius(0.6) * WAYS.bend_radps == pytest.approx(0.6)


@given(places)
def test_mirrored_starts_have_mirrored_ways(start):
    assume(abs(start[1]) > 1e-3)
    path, mirrored = WAYS.quickest(start, 0.3), WAYS.quickest((start[0], -start[1], -start[2]), 0.3)
    assert mirrored.length == pytest.approx(path.length)
    assert mirrored.start[2] == pytest.approx(-path.start[2])


@given(places, st.floats(0.0, 1.0), speeds)
def test_ball_on_the_way_of_a_subgoal_is_a_certain_bump(start, share, vg):
    x, y, _ = start
    assume(abs(y) > 0.05 and math.hypot(x + WAYS.run_in_m, y) > 0.3)
    path = WAYS._bent(x, y, 1 if y > 0.0 else -1, WAYS.radius(vg))
    ball = path.at(share * (path.length - WAYS.run_in_m))
    # the points that are looked at are not so near to each other that long straights had none far from any
    assume(path.pieces[0][1] < 3.0)
    action = np.array([0.0, 0.0, 0.0, 0.0, ball[0], ball[1], 0.0, 0.0])
    subgoal = np.array([[x, y, 0.0, 0.0, 0.0, 0.0, 0.0, vg]])
    assert BallContactRisk(WAYS)(subgoal, action)[0] == 1.0


def test_bump_risk_knows_the_subgoals_of_the_domain():
    soccer = domains.load("soccer")
    assert soccer.actions["approachBall"].subgoal_risk.ways == soccer.actions["goToPose"].controller.ways
