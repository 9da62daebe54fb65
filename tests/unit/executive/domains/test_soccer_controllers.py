"""goToPose and dribbleBall drive the simulated body to their goals, smoothly, and detect their failures."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive import domains
from tailor.executive.actions.dribble_ball import Fetching, Pushing
from tailor.executive.actions.dubins import shortest
from tailor.executive.actions.go_to_pose import ALIGN
from tailor.executive.actions.path_follower import Deviation, Pace, Progress, project, speed_limit, tracking_curvature
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer.belief import unknown
from tailor.executive.domains.soccer.robot import OMEGA_MAX_RADPS, V_MAX_MPS
from tailor.tools.lockstep.action_run import new_body, run_action, sample_arguments

SOCCER = domains.load("soccer")
BODY = new_body(SOCCER)
GO, DRIBBLE = (SOCCER.actions[name].controller for name in ("goToPose", "dribbleBall"))
SECOND_NS = 1_000_000_000


def played(name, number, **options):
    rng = np.random.default_rng([21, number])
    return run_action(BODY, SOCCER, name, sample_arguments(SOCCER, name, rng), rng, **options)


def believing(x=0.0, y=0.0, phi=0.0, v=0.0, omega=0.0, ball=None):
    pose = Pose(x, y, phi, (1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4))
    return dataclasses.replace(unknown(), pose=pose, v=v, omega=omega, ball=ball, poses_seen=99)


def goal(x, y, phi, v=0.0):
    return np.array([0.0, 0.0, 0.0, 0.0, x, y, phi, v])


@pytest.mark.parametrize("number", range(12))
def test_robot_arrives_at_its_goal_pose(number):
    episode = played("goToPose", number, traced=True)
    xg, yg, phig, vg = episode.arguments[4:]
    end = episode.trace[-1].truth
    assert episode.done
    assert math.hypot(end.x - xg, end.y - yg) < 0.35
    assert abs(math.remainder(end.phi - phig, math.tau)) < 0.35
    assert end.v < vg + 0.2


@pytest.mark.parametrize("number", range(8))
def test_ball_arrives_at_its_target_in_the_rail(number):
    episode = played("dribbleBall", number, traced=True)
    x, y, phi = episode.arguments[4:7]
    end = episode.trace[-1].truth
    assert episode.success
    assert math.hypot(end.ball_x - x - 0.31 * math.cos(phi), end.ball_y - y - 0.31 * math.sin(phi)) < 0.5
    assert math.hypot(end.ball_x - end.x, end.ball_y - end.y) < 0.45


def test_approach_that_sweeps_over_the_ball_is_a_collision_but_still_arrives():
    start = np.array([0.0, 0.0, 0.0, 0.6, 0.91, 0.0, math.pi, 0.0])  # at full speed, the ball half a metre ahead
    episode = run_action(BODY, SOCCER, "approachBall", start, np.random.default_rng(1))
    assert (episode.success, episode.failure, episode.done) == (False, "collision", True)
    straight = np.array([0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0])
    assert run_action(BODY, SOCCER, "approachBall", straight, np.random.default_rng(1)).success


def test_time_limit_is_reported_as_the_failure():
    episode = played("goToPose", 1, limit_s=1.0)
    assert (episode.done, episode.failure, episode.duration_s) == (False, "time limit", pytest.approx(0.9))


def test_examples_begin_at_the_start_and_keep_the_goal():
    episode = played("goToPose", 2)
    assert episode.ticks.shape == (round(episode.duration_s * 10) + 1, 8)
    assert np.allclose(episode.ticks[0], episode.arguments, atol=0.15)
    assert (episode.ticks[:, 4:] == episode.arguments[4:]).all()


def test_duration_changes_little_when_the_goal_does():
    def duration(turn):
        arguments = np.array([0.0, 0.0, 0.0, 0.0, 2.5, 0.5, turn, 0.0])
        noise = [np.random.default_rng(number) for number in range(3)]
        return np.mean([run_action(BODY, SOCCER, "goToPose", arguments, rng).duration_s for rng in noise])

    curve = [duration(turn) for turn in np.arange(-0.6, 0.61, 0.2)]
    assert max(abs(np.diff(curve))) < 1.2, "stopping to turn on the spot costs a second"


def test_robot_stops_turning_before_it_reports_its_arrival():
    control = GO(ALIGN, 0, believing(omega=-1.2, phi=0.05), goal(0.0, 0.0, 0.0))
    assert control.outcome == "running"
    assert GO(ALIGN, 0, believing(omega=-0.1, phi=0.05), goal(0.0, 0.0, 0.0)).outcome == "done"


def test_turning_on_the_spot_and_driving_do_not_alternate():
    near = believing(x=0.2, phi=0.15)
    assert GO(ALIGN, 0, near, goal(0.0, 0.0, 0.0)).state == ALIGN
    assert GO(None, 0, near, goal(0.0, 0.0, 0.0)).state != ALIGN


def test_way_is_kept_from_before_its_bend_to_the_goal():
    far = GO(None, 0, believing(x=-3.0, y=1.0, v=0.5), goal(0.0, 0.0, 0.0, 0.5))
    near = GO(None, 0, believing(x=-0.6, y=0.2, phi=-0.4, v=0.5), goal(0.0, 0.0, 0.0, 0.5))
    assert far.state is None
    assert isinstance(near.state, Progress)
    kept = GO(near.state, 0, believing(x=-0.55, y=0.2, phi=-0.4, v=0.5), goal(0.0, 0.0, 0.0, 0.5))
    assert kept.state.path == near.state.path
    moved = GO(near.state, 0, believing(x=-0.55, y=0.2, phi=-0.4, v=0.5), goal(0.0, 0.8, 0.0, 0.5))
    assert moved.state is None or moved.state.path != near.state.path, "the goal is elsewhere now"


def test_robot_passes_its_goal_at_the_goal_speed():
    speeds = []
    for number in range(16):
        rng = np.random.default_rng([22, number])
        arguments = sample_arguments(SOCCER, "goToPose", rng)
        arguments[7] = 0.5
        speeds.append(run_action(BODY, SOCCER, "goToPose", arguments, rng, traced=True).trace[-1].truth.v)
    assert sum(speed > 0.3 for speed in speeds) >= 14
    assert max(speeds) < 0.7


def test_robot_has_braked_to_a_low_goal_speed_when_it_arrives():
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.3])
    runs = [run_action(BODY, SOCCER, "goToPose", arguments, np.random.default_rng(n), traced=True) for n in range(20)]
    faster = np.mean([run.trace[-1].truth.v for run in runs]) - 0.3
    assert abs(faster) < 0.03, "a robot that brakes a tick late rolls into the ball"


def test_robot_that_turns_one_way_and_bends_the_other_over_a_metre_arrives_on_the_line_of_its_goal():
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 0.69, -0.79, -0.15, 0.3])
    ends = [
        run_action(BODY, SOCCER, "goToPose", arguments, np.random.default_rng(n), traced=True).trace[-1].truth
        for n in range(12)
    ]
    aside = [math.cos(-0.15) * (end.y + 0.79) - math.sin(-0.15) * (end.x - 0.69) for end in ends]
    assert abs(np.mean(aside)) < 0.06, "a ball is met by the tip of the rail"


@settings(max_examples=200, deadline=None)
@given(*(st.floats(-3.0, 3.0) for _ in range(3)), st.floats(-0.3, 0.9), st.floats(-1.75, 1.75), st.floats(0.0, 0.6))
def test_commands_are_within_the_robots_limits(x, y, phi, v, omega, vg):
    for controller in (GO, SOCCER.actions["approachBall"].controller):
        control = controller(None, 0, believing(x, y, phi, v, omega), goal(0.0, 0.0, 0.0, vg))
        for _ in range(2):  # with the state of the first
            assert 0.0 <= control.command[0] <= V_MAX_MPS
            assert abs(control.command[1]) <= OMEGA_MAX_RADPS
            control = controller(control.state, 0, believing(x, y, phi, v, omega), goal(0.0, 0.0, 0.0, vg))


def seen(ahead, left, seen_ns=0):
    return BallTrack(ahead, left, 0.0, 0.0, 1e-4, seen_ns)


def test_ball_is_seated_before_it_is_pushed():
    ahead = DRIBBLE(None, 0, believing(ball=seen(0.45, 0.0)), goal(2.0, 0.0, 0.0))
    assert isinstance(ahead.state, Fetching)
    assert 0.0 < ahead.command[0] < 0.4
    assert isinstance(DRIBBLE(ahead.state, 0, believing(ball=seen(0.31, 0.0)), goal(2.0, 0.0, 0.0)).state, Pushing)


def test_robot_backs_off_from_a_ball_beside_it():
    control = DRIBBLE(None, 0, believing(ball=seen(0.2, 0.25)), goal(2.0, 0.0, 0.0))
    assert control.state == Fetching("clear")
    assert control.command == (-0.25, 0.0)


def test_slipping_ball_is_steered_after():
    pushing = DRIBBLE(None, 0, believing(v=0.4, ball=seen(0.31, 0.0)), goal(0.5, -1.5, -2.0)).state
    slipping = DRIBBLE(pushing, 0, believing(v=0.4, omega=-0.6, ball=seen(0.36, 0.08)), goal(0.5, -1.5, -2.0))
    assert slipping.state.slipping
    assert slipping.command[1] > 0.0, "the path turns right, the ball left"


def test_straight_on_a_ball_to_the_right_is_pushed_as_one_to_the_left():
    """The sign of a zero yaw rate decided whether the robot took the ball for creeping out of a turn."""
    pushing = DRIBBLE(None, 0, believing(v=0.3, ball=seen(0.31, 0.0)), goal(2.0, 0.0, 0.0)).state
    commands = [
        DRIBBLE(pushing, 0, believing(v=0.3, ball=seen(0.31, left)), goal(2.0, 0.0, 0.0)).command
        for left in (0.0, -0.03, 0.03)
    ]
    assert commands[0] == commands[1] == commands[2]
    assert commands[0][1] == 0.0


@pytest.mark.parametrize("goal_x", [-1.0, 2.0])
def test_escaped_ball_is_left_only_if_fetching_it_would_lead_round_in_a_circle(goal_x):
    pushing = DRIBBLE(None, 0, believing(v=0.4, ball=seen(0.31, 0.0)), goal(goal_x, 0.0, 0.0)).state
    escaped = DRIBBLE(pushing, 0, believing(v=0.4, ball=seen(0.65, 0.0)), goal(goal_x, 0.0, 0.0))
    assert (escaped.command[0] < 0.0) == (goal_x == -1.0), "the ball lies past the first goal, before the second"
    farther = DRIBBLE(escaped.state, 0, believing(v=-0.2, ball=seen(0.8, 0.0)), goal(goal_x, 0.0, 0.0))
    assert farther.outcome == ("failed" if goal_x == -1.0 else "running")


@pytest.mark.parametrize(
    ("ball", "now_ns", "reason"),
    [(None, 0, "the ball was never seen"), (seen(1.5, 0.0), 0, "the ball got away")],
)
def test_dribble_fails_with_a_detail(ball, now_ns, reason):
    control = DRIBBLE(None, now_ns, believing(ball=ball), goal(2.0, 0.0, 0.0))
    assert (control.outcome, control.detail) == ("failed", reason)


def test_ball_that_should_be_in_view_and_is_not_is_sought_during_one_turn():
    hidden, state = believing(ball=seen(0.31, 0.05)), None
    for tick in range(100):
        control = DRIBBLE(state, 2 * SECOND_NS + tick * SECOND_NS // 10, hidden, goal(2.0, 0.0, 0.0))
        if control.outcome == "failed":
            break
        state = control.state
        assert control.command == (0.0, 1.0)
    assert control.detail == "the ball was not found"
    assert tick > 63, "a full turn at 1 rad/s"


def test_time_in_which_the_robot_is_held_is_no_time_of_a_search():
    hidden, arguments = believing(ball=seen(0.31, 0.05)), goal(2.0, 0.0, 0.0)
    searching = DRIBBLE(None, 2 * SECOND_NS, hidden, arguments)
    resumed = DRIBBLE(searching.state, 20 * SECOND_NS, hidden, arguments)
    assert (resumed.outcome, resumed.command) == ("running", (0.0, 1.0))


PACE = Pace(0.75, 0.35, 0.35, 0.20)


def test_bends_and_the_end_are_met_without_braking_hard():
    path = shortest((0.0, 0.0, 0.0), (3.0, 1.0, math.pi / 2), 0.55)
    speeds = [speed_limit(Progress(path, s), 0.0, PACE) for s in np.arange(0.0, path.length, 0.01)]
    assert max(speeds) == 0.75
    assert speeds[-1] < 0.1
    falls = -np.diff(np.square(speeds)) / 0.02
    assert falls.max() < 0.36
    bend = path.pieces[0][1] + path.pieces[1][1]
    assert speed_limit(Progress(path, bend + 0.01), 0.35, PACE) <= 0.35 + 1e-9


def test_projection_never_goes_back_and_finds_the_side():
    path = shortest((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), 0.5)
    progress, off = project(Progress(path, 1.0), believing(x=1.2, y=0.1, phi=0.2).pose, 0.3)
    assert (progress.s, off.aside_m, off.turned) == pytest.approx((1.2, 0.1, 0.2))
    assert project(progress, believing(x=0.5).pose, 0.3)[0].s == progress.s


def test_robot_beside_its_path_turns_back_to_it():
    progress = Progress(shortest((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), 0.5), 1.0)
    assert tracking_curvature(progress, Deviation(0.1, 0.0), 0.1, 0.4) < 0.0
    assert tracking_curvature(progress, Deviation(0.0, -0.1), 0.1, 0.4) > 0.0
    assert tracking_curvature(progress, Deviation(0.0, 0.0), 0.1, 0.4) == 0.0
