"""What keeps the ball in the rail (gentle turns, a straight run-in), and how alike dribbles are that begin alike."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.actions.dribble_ball import Fetching, Pushing
from tailor.executive.actions.dribble_path import DribblePath
from tailor.executive.actions.rail_grip import RailGrip
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import robot
from tailor.executive.domains.soccer.belief import unknown
from tailor.simnodes.agilo.body import AgiloBody
from tailor.tools.lockstep.action_run import new_body, run_action, sample_arguments

GRIP = RailGrip(robot.IN_RAIL_M, robot.BALL_ROLLING_MPS2)
PATHS = DribblePath(0.75, lambda radius: GRIP.bend_mps(radius, 0.945), robot.IN_RAIL_M, 0.5, braking_mps2=0.35)
SOCCER = domains.load("soccer")


def ball_held(v, omega):
    """Whether the simulated ball is still in the rail after six seconds of a turn begun gently."""
    body = AgiloBody()
    body.reset(np.random.default_rng(0), {"v": v, "ball_x": robot.IN_RAIL_M, "ball_y": 0.0, "ball_vx": v})
    for tick in range(90):
        body.command((v, min(omega, 0.03 * tick)))
        body.advance(100_000_000)
    truth = body.ground_truth()
    return abs(math.hypot(truth.ball_x - truth.x, truth.ball_y - truth.y) - robot.IN_RAIL_M) < 0.03


@pytest.mark.parametrize("v", [0.25, 0.36, 0.5, 0.6])
def test_turns_that_the_grip_allows_keep_the_simulated_ball_and_much_sharper_ones_lose_it(v):
    allowed = max(rate for rate in np.arange(0.0, 1.5, 0.01) if GRIP.yaw_radps2(v, rate, 0.0) > 0.0)
    assert ball_held(v, allowed)
    assert not ball_held(v, 1.35 * allowed)


def test_straight_ahead_only_the_rolling_resistance_limits_braking():
    assert GRIP.braking_mps2(0.4, 0.0) == pytest.approx(robot.BALL_ROLLING_MPS2)
    assert GRIP.braking_mps2(0.0, 0.0) == 0.0, "a ball at rest pushes back with nothing"


def test_grip_is_the_same_to_both_sides_and_less_the_sharper_the_turn():
    rates = np.arange(0.0, 0.8, 0.1)
    braking = [GRIP.braking_mps2(0.4, rate) for rate in rates]
    yaw = [GRIP.yaw_radps2(0.4, rate, 0.1) for rate in rates]
    assert braking == [GRIP.braking_mps2(0.4, -rate) for rate in rates]
    assert yaw == [GRIP.yaw_radps2(0.4, -rate, 0.1) for rate in rates]
    assert all(np.diff(braking) <= 0.0)
    assert all(np.diff(yaw) <= 0.0)


@pytest.mark.parametrize("radius", [0.36, 0.65, 1.0])
def test_speed_of_a_bend_pushes_the_ball_at_the_angle_that_was_requested(radius):
    v = GRIP.bend_mps(radius, GRIP.steepest_rad)
    assert GRIP.yaw_radps2(v, v / radius, 0.0) == pytest.approx(0.0, abs=1e-9)
    assert GRIP.bend_mps(radius, 0.9) < v
    assert GRIP.bend_mps(0.1, 0.9) == 0.0, "so tight a bend holds no ball at any speed"


def planned(goal, v=0.25):
    return PATHS.quickest(SimpleNamespace(x=0.0, y=0.0, phi=0.0), v, goal)


@pytest.mark.parametrize("phi", np.arange(-3.0, 3.1, 0.5))
def test_planned_path_begins_straight_and_brings_the_ball_to_its_target(phi):
    goal = (1.2, 0.7, float(phi), 0.0)
    path = planned(goal)
    assert path.at(0.0)[:3] == pytest.approx((0.0, 0.0, 0.0))
    assert path.pieces[0] == (0, PATHS.run_in_m)
    x, y, heading, _ = path.at(path.length)
    ball = x + robot.IN_RAIL_M * math.cos(heading), y + robot.IN_RAIL_M * math.sin(heading)
    target = goal[0] + robot.IN_RAIL_M * math.cos(phi), goal[1] + robot.IN_RAIL_M * math.sin(phi)
    assert math.dist(ball, target) <= max(PATHS.asides_m) + 1e-9
    assert abs(math.remainder(heading - phi, math.tau)) <= max(PATHS.slants_rad) + 1e-9


@pytest.mark.parametrize(("aside", "circles"), [(0.0, False), (0.15, False), (0.29, False), (0.31, True)])
def test_near_its_target_and_in_motion_the_ball_is_stopped_straight_ahead_rather_than_led_around(aside, circles):
    path = planned((0.45, aside, 0.0, 0.0), v=0.45)
    assert (path.length > 1.0) == circles


def test_a_straight_stop_is_never_planned_shorter_than_the_ball_can_be_braked():
    path = planned((0.1, 0.0, 0.0, 0.0), v=0.45)
    assert path.length == pytest.approx(0.45**2 / (2.0 * PATHS.braking_mps2))


def test_speed_that_the_run_in_takes_off_does_not_widen_the_bends():
    goal = (0.9, 0.6, 2.0, 0.0)
    assert planned(goal, 0.34).radius == planned(goal, 0.28).radius
    assert planned(goal, 0.7).radius > max(PATHS.radii_m)


def test_same_dribble_takes_about_as_long_whatever_the_noise():
    body, spreads = new_body(SOCCER), []
    for number in range(12):
        arguments = sample_arguments(SOCCER, "dribbleBall", np.random.default_rng([22, number]))
        noise = [np.random.default_rng([23, number, repeat]) for repeat in range(4)]
        took = [run_action(body, SOCCER, "dribbleBall", arguments, rng).duration_s for rng in noise]
        spreads.append(np.abs(np.array(took) - np.median(took)).mean())
    assert np.mean(spreads) < 0.2


BEYOND = np.array([0.0, 0.0, 0.0, 0.0, -0.6, 0.0, 0.0, 0.0])  # a goal behind the robot, with its heading: a circle
AHEAD = np.array([0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0])


def dribble(state, ball_ahead, arguments, v=0.2):
    pose = Pose(0.0, 0.0, 0.0, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4))
    belief = replace(unknown(), pose=pose, v=v, ball=BallTrack(ball_ahead, 0.0, 0.0, 0.0, 1e-4, 0), poses_seen=99)
    return SOCCER.actions["dribbleBall"].controller(state, 0, belief, arguments)


def test_a_ball_that_was_kicked_before_it_was_ever_in_the_rail_is_left_unless_it_lies_right():
    far = robot.IN_RAIL_M + 0.3
    left = dribble(None, far, BEYOND)
    assert left.state.stage == "leave"
    assert left.command[0] < 0.0
    assert dribble(None, far, AHEAD).state.stage == "chase"


def test_a_ball_that_was_fetched_to_a_place_from_which_only_a_circle_leads_on_is_left():
    chasing, seated = Fetching("chase", far=True), robot.IN_RAIL_M + 0.01
    assert dribble(chasing, seated, BEYOND).state.stage == "leave"
    assert isinstance(dribble(chasing, seated, AHEAD).state, Pushing)


def test_a_dribble_that_begins_with_a_circle_is_driven_as_it_was_chosen():
    state = dribble(None, robot.IN_RAIL_M + 0.05, BEYOND).state
    assert (state.stage, state.far) == ("chase", False)
    assert isinstance(dribble(state, robot.IN_RAIL_M + 0.01, BEYOND).state, Pushing)


@pytest.mark.parametrize("past_m", [0.0, 0.1, 0.2])
def test_a_robot_at_rest_at_its_goal_or_a_little_past_it_has_nothing_left_to_divide_by(past_m):
    there = np.array([0.0, 0.0, 0.0, 0.0, -past_m, 0.0, 0.0, 0.0])
    assert dribble(None, robot.IN_RAIL_M, there, v=0.0).outcome == "done"
