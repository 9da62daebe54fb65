"""Two balls as the soccer robot knows them: labels, facts and actions are about the right one."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import balls, robot
from tailor.executive.domains.soccer.belief import unknown, update
from tailor.executive.interfaces.domain import LabelQuery, Scenario
from tailor.executive.interfaces.values import Interval
from tailor.schemas.messages import Odometry, PoseEstimate, Sample
from tailor.schemas.messages.soccer import BallPercept
from tailor.tools.lockstep.action_run import new_body

SOCCER = domains.load("soccer")
LABELS = {"robot_label": "pos1", "ball_label": "pos2", "ball2_label": "pos3", "target_label": "pos4"}
SCENARIO = Scenario("two-balls", "", {"pos4": {"x": 3.0, "y": 0.0, "phi": 0.0, "v": 0.0}}, LABELS)
IN_RAIL = (robot.IN_RAIL_M, 0.0)


def believe(ball, ball2, x=0.0, y=0.0):
    """A robot at (x, y) that looks along x, and balls in its frame."""
    pose = Pose(x, y, 0.0, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4))
    tracks = [None if at is None else BallTrack(*at, 0.0, 0.0, 1e-4, 0) for at in (ball, ball2)]
    return replace(unknown(), pose=pose, ball=tracks[0], ball2=tracks[1], poses_seen=99)


def facts(belief, remembered=frozenset({("final", "pos4")})):
    return SOCCER.anchor(belief, SCENARIO, remembered) - {("final", "pos4")}


def x_of(label, fact, belief):
    return SOCCER.value(LabelQuery("x", label, ((fact, label),), (), belief, SCENARIO))


def test_each_ball_lies_at_its_own_label_while_the_robot_holds_none():
    belief = believe((1.0, 0.0), (2.0, 1.0))
    assert facts(belief) == {("robot", "pos1"), ("ball", "pos2"), ("ball", "pos3")}
    assert x_of("pos2", "ball", belief) == Interval(1.0, 1.0)
    assert x_of("pos3", "ball", belief) == Interval(2.0, 2.0)


def test_a_ball_that_was_not_seen_is_none_to_plan_with():
    assert facts(believe((1.0, 0.0), None)) == {("robot", "pos1"), ("ball", "pos2")}
    assert facts(believe(None, (2.0, 1.0))) == {("robot", "pos1"), ("ball", "pos3")}


@pytest.mark.parametrize(("seen", "mine", "other"), [((IN_RAIL, (2.0, 1.0)), "pos2", "pos3"),
                                                     (((2.0, 1.0), IN_RAIL), "pos3", "pos2")])  # fmt: skip
def test_the_ball_in_the_rail_is_the_one_that_the_robot_has(seen, mine, other):
    assert facts(believe(*seen)) == {("robot", mine), ("ball", mine), ("atball", mine), ("ball", other)}
    assert x_of(mine, "atball", believe(*seen)) == Interval(robot.IN_RAIL_M, robot.IN_RAIL_M)
    assert x_of(other, "ball", believe(*seen)) == Interval(2.0, 2.0)
    at_target = facts(believe(*seen, x=2.7))
    assert at_target == {("robot", "pos4"), ("ball", "pos4"), ("atball", "pos4"), ("ball", other)}


def test_of_two_balls_before_the_robot_it_has_the_nearer_one():
    belief = believe((0.55, 0.1), (0.33, 0.0))
    assert facts(belief) == {("robot", "pos3"), ("ball", "pos3"), ("atball", "pos3"), ("ball", "pos2")}


@pytest.mark.parametrize("swapped", [False, True])
def test_actions_are_about_the_ball_of_their_arguments(swapped):
    """The same commands as with that ball alone, whichever of the two it is and wherever the other one lies."""
    for name, mine, goal in (
        ("approachBall", (2.0, 0.1), (2.0 - robot.BEHIND_BALL_M, 0.0, 0.0, 0.2)),
        ("dribbleBall", (0.34, 0.02), (1.5, 0.5, 0.4, 0.0)),
    ):
        arguments, other = np.array([0.0, 0.0, 0.0, 0.0, *goal]), (1.0, -0.2)
        controller, both = SOCCER.actions[name].controller, believe(*((other, mine) if swapped else (mine, other)))
        assert (
            controller(None, 0, both, arguments).command == controller(None, 0, believe(mine, None), arguments).command
        )
        assert (
            controller(None, 0, believe(other, None), arguments).command != controller(None, 0, both, arguments).command
        )


def test_percepts_update_the_ball_of_their_topic():
    belief = replace(unknown(), pose=Pose(0.0, 0.0, 0.0, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4)), time_ns=1)
    percepts = [Sample(f"agilo/{topic}", BallPercept(2, x, 0.0, 1e-4, 1e-4, 0.0), 2, 1)
                for topic, x in (("ball2", 2.0), ("ball", 1.0))]  # fmt: skip
    belief = update(belief, 3, tuple(percepts), "agilo")
    assert (belief.ball_xy, belief.ball2_xy) == (pytest.approx((1.0, 0.0)), pytest.approx((2.0, 0.0)))
    others = (Odometry(4, 0, 0, 0, 0.5, 0.0), PoseEstimate(4, 0, 0, 0, 1e-4, 1e-4, 1e-4))
    driven = update(belief, 4, tuple(Sample("agilo/any", other, 4, 1) for other in others), "agilo")
    assert driven.ball2 is not None


@pytest.mark.parametrize(("key", "second"), [("agilo/ball2", True), ("ball2", True), ("agilo/sim/ball2", False),
                                             ("other/ball2", False), ("agilo/ball", False)])  # fmt: skip
def test_a_percept_is_the_second_balls_by_its_whole_key(key, second):
    belief = update(unknown(), 3, (Sample(key, BallPercept(2, 1.0, 0.0, 1e-4, 1e-4, 0.0), 2, 1),), "agilo")
    assert (belief.ball is None, belief.ball2 is None) == (second, not second)


def test_telemetry_names_a_second_ball_once_it_was_seen():
    names, alone = SOCCER.belief_names, believe((1.0, 0.0), None)
    assert len(SOCCER.belief_values(alone)) == len(names) - len(balls.NAMES) - 16
    values = dict(zip(names, SOCCER.belief_values(believe((1.0, 0.0), (2.0, 1.0))), strict=True))
    assert (values["ball2_x (m)"], values["ball2_y (m)"], values["ball2_sigma (m)"]) == (2.0, 1.0, 0.01)
    assert values["opponent1_sigma (m)"] == -1.0


def test_the_scenario_draws_two_balls_alike():
    """Both are in view and as far from robot and target; none is nearer to the robot more often."""
    nearer = 0
    for seed in range(60):
        scenario, start = domains.seeded_scenario("soccer", "two-balls", seed)
        robot_at, at = (
            (start["x"], start["y"]),
            [(start[f"{ball}_x"], start[f"{ball}_y"]) for ball in ("ball", "ball2")],
        )
        distances = [float(np.hypot(x - robot_at[0], y - robot_at[1])) for x, y in at]
        assert all(1.0 <= distance <= 3.0 for distance in distances)
        bearings = [np.arctan2(y - robot_at[1], x - robot_at[0]) - start["phi"] for x, y in at]
        assert max(abs(np.arctan2(np.sin(b), np.cos(b))) for b in bearings) <= 0.7
        nearer += distances[0] < distances[1]
        (target,) = scenario.places.values()
        lines = [np.arctan2(target["y"] - y, target["x"] - x) for x, y in at]
        assert max(abs(math.remainder(target["phi"] - line, math.tau)) for line in lines) <= 1.3, "or dribbles circle"
    assert 18 <= nearer <= 42
    assert set(start) <= set(new_body(SOCCER).names)
