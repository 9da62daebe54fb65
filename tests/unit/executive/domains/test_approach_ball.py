"""An approach keeps its goal where the ball is seen, arrives without a swing, and its asserted subgoals avoid it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import robot
from tailor.executive.domains.soccer.belief import unknown
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.support.synthetic_models import APPROACH, DRIBBLE, MODELS, sequence

SOCCER = domains.load("soccer")
APPROACHING = SOCCER.actions["approachBall"].controller.controller
GO = APPROACHING.go
BUMP_RISK = SOCCER.actions["approachBall"].subgoal_risk
GOAL = np.array([0.0, 0.0, 0.0, 0.0, 2.0 - robot.BEHIND_BALL_M, 0.0, 0.0, 0.2])  # behind a ball at (2, 0)


def believing(ball_xy=None, x=0.0, y=0.0):
    """A robot at (x, y) that looks along x."""
    pose = Pose(x, y, 0.0, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4))
    ball = None if ball_xy is None else BallTrack(ball_xy[0] - x, ball_xy[1] - y, 0.0, 0.0, 1e-4, 0)
    return replace(unknown(), pose=pose, ball=ball, poses_seen=99)


def test_goal_follows_the_ball_as_far_as_it_was_seen_elsewhere() -> None:
    shifted = GOAL + np.array([0, 0, 0, 0, 0.1, 0.12, 0, 0])
    belief = believing((2.1, 0.12))
    assert APPROACHING(None, 0, belief, GOAL) == GO(None, 0, belief, shifted)
    assert APPROACHING(None, 0, belief, GOAL) != GO(None, 0, belief, GOAL)


def test_goal_follows_the_ball_until_the_executive_takes_it_for_moved_along_either_axis() -> None:
    shifted = GOAL + np.array([0, 0, 0, 0, 0.2, 0.2, 0, 0])
    belief = believing((2.2, 0.2))  # 0.28 m off
    assert APPROACHING(None, 0, belief, GOAL).command == pytest.approx(GO(None, 0, belief, shifted).command)
    assert APPROACHING(None, 0, belief, GOAL).command != pytest.approx(GO(None, 0, belief, GOAL).command)


@pytest.mark.parametrize("ball_xy", [None, (2.0, 0.3)], ids=["not seen", "moved: another task"])
def test_goal_stays_where_there_is_no_ball_to_follow(ball_xy) -> None:
    belief = believing(ball_xy)
    assert APPROACHING(None, 0, belief, GOAL) == GO(None, 0, belief, GOAL)


@pytest.mark.parametrize("aside_m", [-0.04, 0.04])
@pytest.mark.parametrize("before_m", [0.05, 0.15, 0.30])
def test_a_few_centimetres_aside_do_not_swing_the_robot_round_at_its_goal(aside_m, before_m) -> None:
    goal = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2])
    _, omega = GO(None, 0, believing(None, -before_m, aside_m), goal).command
    assert omega * aside_m < 0.0, "towards the goal's line"
    assert abs(omega) < 0.5


def subgoals(*goals: tuple[float, float, float]) -> np.ndarray:
    """goToPose's parameters from the origin to goals (x, y, phi)."""
    return np.array([[0.0, 0.0, 0.0, 0.0, *goal, 0.2] for goal in goals])


def test_a_way_through_the_ball_is_a_risk_and_one_round_it_is_none() -> None:
    ball_at = np.array([0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0])
    through, beside, round_it = BUMP_RISK(subgoals((3.0, 0.0, 0.0), (3.0, 0.8, 0.0), (1.5, 1.5, 1.57)), ball_at)
    assert through == 1.0
    assert 0.0 < beside < 1.0
    assert round_it == 0.0


def test_subgoal_that_may_spoil_its_action_costs_what_a_failure_costs() -> None:
    settings = RefinementSettings(arrival_spread=(), risk_cost_s=8.0)
    risky = replace(APPROACH, subgoal_risk=lambda rows, action: np.full(len(rows), 0.25 * action[4]))
    start = {"x": -1.0, "y": 0.0, "phi": 0.0, "v": 0.0}
    costs = []
    for approach in (APPROACH, risky):
        given = sequence([approach, DRIBBLE], [start, {"x": 1.0, "y": 0.0, "phi": 0.0, "v": 0.0}, start])
        asserted = with_subgoal(given, 0)
        objective = SequenceObjective(asserted.actions[:1], asserted.variables, MODELS, settings)
        assert objective.stages[0].predict(np.zeros((1, 4))).failure[0] == 0.0, "alone it spoils nothing"
        objective = SequenceObjective(asserted.actions[:2], asserted.variables, MODELS, settings)
        costs.append(objective.stages[0].cost(np.zeros((1, 4)))[0])
    assert costs[1] - costs[0] == pytest.approx(0.25 * 1.0 * settings.risk_cost_s)
    assert math.isfinite(costs[0])
