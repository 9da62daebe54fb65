"""The reach controller and its cubics: smooth, bounded, and on time."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.actions.cubic import best_duration_s, cubic
from tailor.executive.domains.arm.action_library import (
    ACCELERATION_MAX_RADPS2,
    ACCELERATION_RADPS2,
    PASSING_RADPS,
    REACH,
    fastest_radps,
)
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.robot import V_MAX_RADPS

PERIOD_NS = 100_000_000
angle = st.floats(-0.9, 0.9)
speed = st.floats(-PASSING_RADPS, PASSING_RADPS)
joints = st.tuples(angle, angle)
speeds = st.tuples(speed, speed)


def cost(q0, v0, q1, v1, duration_s, acceleration):
    """What a motion costs, by summing the acceleration's square up in small steps."""
    made, steps = cubic(q0, v0, q1, v1, duration_s), 4000
    times = (np.arange(steps) + 0.5) * duration_s / steps
    square = sum((2 * b + 6 * c * times) ** 2 for b, c in zip(made.b, made.c, strict=True))
    return duration_s + float(square.mean()) * duration_s / acceleration**2


@given(joints, speeds, joints, speeds, st.floats(0.2, 8.0))
def test_a_cubic_has_the_given_ends(q0, v0, q1, v1, duration_s):
    made = cubic(q0, v0, q1, v1, duration_s)
    assert made.angles(0.0) == pytest.approx(q0)
    assert made.velocities(0.0) == pytest.approx(v0)
    assert made.angles(duration_s) == pytest.approx(q1, abs=1e-9)
    assert made.velocities(duration_s) == pytest.approx(v1, abs=1e-9)


def test_the_best_duration_costs_least():
    states = ((0.0, 0.2), (0.5, -0.3), (0.7, -0.4), (-0.2, 0.6))
    best = best_duration_s(*states, 0.9)
    least = cost(*states, best, 0.9)
    assert all(cost(*states, factor * best, 0.9) > least for factor in (0.5, 0.9, 0.99, 1.01, 1.1, 2.0))


def test_from_rest_to_rest_the_largest_acceleration_is_the_given_one():
    for distance in (0.1, 0.5, 2.0):
        states = ((0.0, 0.0), (0.0, 0.0), (distance, 0.0), (0.0, 0.0))
        made = cubic(*states, best_duration_s(*states, 0.8))
        assert made.peak_acceleration == pytest.approx(0.8, rel=1e-6)


@given(joints, speeds, joints, speeds, st.floats(0.1, 0.9))
def test_a_later_point_of_the_motion_confirms_the_time_that_is_left(q0, v0, q1, v1, share):
    if math.dist(q0, q1) < 0.3:
        return  # so near two durations can be nearly as good
    duration_s = best_duration_s(q0, v0, q1, v1, 0.9)
    made = cubic(q0, v0, q1, v1, duration_s)
    t = share * duration_s
    left_s = best_duration_s(made.angles(t), made.velocities(t), q1, v1, 0.9)
    assert left_s == pytest.approx(duration_s - t, abs=0.02)


def test_duration_hardly_changes_when_a_goal_velocity_hardly_does():
    rng = np.random.default_rng(3)
    for _ in range(60):
        q0, v0, v1 = rng.uniform(-0.9, 0.9, 2), rng.uniform(-1, 1, 2), rng.uniform(-1, 1, 2)
        distance, direction = rng.uniform(0.05, 2.0), rng.uniform(-np.pi, np.pi)
        q1 = q0 + distance * np.array([np.cos(direction), np.sin(direction)])
        fastest = fastest_radps(distance)
        across = np.linspace(-fastest, fastest, 281)
        line = [best_duration_s(q0, fastest * v0, q1, (fastest * v1[0], w), ACCELERATION_RADPS2) for w in across]
        assert np.abs(np.diff(line)).max() < 0.03  # seconds for a 140th of the range


def drive(start, goal):
    """Run the controller against joints that follow each command exactly; arguments as in Table 6."""
    (q0, v0), (q1, v1) = start, goal
    arguments = np.array([*np.stack((q0, v0), 1).ravel(), *np.stack((q1, v1), 1).ravel()])
    q, v, state, commands = np.array(q0), np.array(v0), None, []
    for tick in range(200):
        belief = ArmBelief(tick * PERIOD_NS, tuple(q.tolist()), tuple(v.tolist()), tick * PERIOD_NS)
        control = REACH.controller(state, tick * PERIOD_NS, belief, arguments)
        command, state = np.array(control.command), control.state
        commands.append(command)
        q, v = q + 0.05 * (v + command), command
        if control.outcome != "running":
            return control, q, v, commands
    raise AssertionError("never arrived")


@given(joints, speeds, joints, speeds)
def test_it_is_done_one_period_before_it_passes_the_waypoint_with_the_goal_velocity(q0, v0, q1, v1):
    control, q, v, _ = drive((q0, v0), (q1, v1))
    assert control.outcome == "done"
    assert math.dist(q, q1) < 0.02
    assert math.dist(v, v1) < 0.03


@given(joints, speeds, joints, speeds)
def test_commands_stay_within_the_drivers_limits(q0, v0, q1, v1):
    share = fastest_radps(math.dist(q0, q1)) / PASSING_RADPS
    v0, v1 = tuple(share * v for v in v0), tuple(share * v for v in v1)
    *_, commands = drive((q0, v0), (q1, v1))
    assert np.abs(commands).max() < V_MAX_RADPS
    changes = np.linalg.norm(np.diff([v0, *commands], axis=0), axis=1) / 0.1
    assert changes.max() < 1.1 * ACCELERATION_MAX_RADPS2


def test_an_arm_that_was_pushed_away_still_arrives():
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 0.8, 0.0, 0.4, 0.0])
    q, v, state = np.zeros(2), np.zeros(2), None
    for tick in range(200):
        if tick == 10:
            q = q - 0.4
        belief = ArmBelief(tick * PERIOD_NS, tuple(q.tolist()), tuple(v.tolist()), tick * PERIOD_NS)
        control = REACH.controller(state, tick * PERIOD_NS, belief, arguments)
        state, command = control.state, np.array(control.command)
        q, v = q + 0.05 * (v + command), command
        if control.outcome == "done":
            break
    assert control.outcome == "done"
    assert math.dist(q, (0.8, 0.4)) < 0.02


def test_a_new_goal_makes_a_new_motion_from_where_the_arm_is():
    belief = ArmBelief(0, (0.1, 0.2), (0.3, 0.0), 0)
    first = REACH.controller(None, 0, belief, np.array([0, 0, 0, 0, 1.0, 0, 0.5, 0]))
    second = REACH.controller(first.state, PERIOD_NS, belief, np.array([0, 0, 0, 0, -1.0, 0, 0.5, 0]))
    assert second.state.started_ns == PERIOD_NS
    assert second.state.cubic.angles(0.0) == (0.1, 0.2)
    assert second.state.goal[0] == -1.0
