"""The reach controller and its cubics: smooth, bounded, and on time."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.actions.cubic import best_duration_s, cubic
from tailor.executive.domains.arm.action_library import (
    ACCELERATION_MAX_RADPS2,
    PASSING_RADPS,
    REACH,
    fastest_radps,
)
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.domains.arm.load import ACCELERATION_RADPS2, accelerations
from tailor.executive.domains.arm.robot import V_MAX_RADPS

PERIOD_NS = 100_000_000
angle = st.floats(-0.9, 0.9)
speed = st.floats(-PASSING_RADPS, PASSING_RADPS)
joints = st.tuples(angle, angle)
speeds = st.tuples(speed, speed)


def cost(q0, v0, q1, v1, duration_s, limits):
    """What a motion costs, by summing the acceleration's square up in small steps."""
    made, steps = cubic(q0, v0, q1, v1, duration_s), 4000
    times = (np.arange(steps) + 0.5) * duration_s / steps
    square = sum(((2 * b + 6 * c * times) / most) ** 2 for b, c, most in zip(made.b, made.c, limits, strict=True))
    return duration_s + float(square.mean()) * duration_s


@given(joints, speeds, joints, speeds, st.floats(0.2, 8.0))
def test_a_cubic_has_the_given_ends(q0, v0, q1, v1, duration_s):
    made = cubic(q0, v0, q1, v1, duration_s)
    assert made.angles(0.0) == pytest.approx(q0)
    assert made.velocities(0.0) == pytest.approx(v0)
    assert made.angles(duration_s) == pytest.approx(q1, abs=1e-9)
    assert made.velocities(duration_s) == pytest.approx(v1, abs=1e-9)


def test_the_best_duration_costs_least():
    states = ((0.0, 0.2), (0.5, -0.3), (0.7, -0.4), (-0.2, 0.6))
    best = best_duration_s(*states, (0.9, 2.0))
    least = cost(*states, best, (0.9, 2.0))
    assert all(cost(*states, factor * best, (0.9, 2.0)) > least for factor in (0.5, 0.9, 0.99, 1.01, 1.1, 2.0))


def test_from_rest_to_rest_the_largest_acceleration_is_the_given_one():
    for distance in (0.1, 0.5, 2.0):
        states = ((0.0, 0.0), (0.0, 0.0), (distance, 0.0), (0.0, 0.0))
        made = cubic(*states, best_duration_s(*states, (0.8, 2.0)))
        assert made.peak_acceleration == pytest.approx(0.8, rel=1e-6)


@given(joints, speeds, joints, speeds, st.floats(0.1, 0.9))
def test_a_later_point_of_the_motion_confirms_the_time_that_is_left(q0, v0, q1, v1, share):
    if math.dist(q0, q1) < 0.3:
        return  # so near two durations can be nearly as good
    duration_s = best_duration_s(q0, v0, q1, v1, (0.9, 0.9))
    made = cubic(q0, v0, q1, v1, duration_s)
    t = share * duration_s
    left_s = best_duration_s(made.angles(t), made.velocities(t), q1, v1, (0.9, 0.9))
    assert left_s == pytest.approx(duration_s - t, abs=0.02)


def test_duration_hardly_changes_when_a_goal_velocity_hardly_does():
    rng = np.random.default_rng(3)
    for _ in range(60):
        q0, v0, v1 = rng.uniform(-0.9, 0.9, 2), rng.uniform(-1, 1, 2), rng.uniform(-1, 1, 2)
        distance, direction = rng.uniform(0.05, 2.0), rng.uniform(-np.pi, np.pi)
        q1 = q0 + distance * np.array([np.cos(direction), np.sin(direction)])
        fastest, limits = fastest_radps(distance), accelerations(q0, q1, (1.0, 1.0))
        across = np.linspace(-fastest, fastest, 281)
        line = [best_duration_s(q0, fastest * v0, q1, (fastest * v1[0], w), limits) for w in across]
        assert np.abs(np.diff(line)).max() < 0.03  # seconds for a 140th of the range


@given(joints, speeds, joints, speeds, st.floats(0.2, 8.0))
def test_the_peak_velocity_is_the_largest_of_the_motion(q0, v0, q1, v1, duration_s):
    made = cubic(q0, v0, q1, v1, duration_s)
    largest = max(abs(v) for t in np.linspace(0.0, duration_s, 2001) for v in made.velocities(t))
    assert made.peak_velocity == pytest.approx(largest, rel=1e-3, abs=1e-6)


def test_a_lift_takes_longer_than_a_descent_and_longer_when_the_gears_are_cold():
    def duration_s(start, goal, friction=1.0):
        limits = accelerations((0.0, start), (0.0, goal), (friction, friction))
        return best_duration_s((0.0, start), (0.0, 0.0), (0.0, goal), (0.0, 0.0), limits)

    assert duration_s(-0.4, 0.4) > 1.2 * duration_s(0.4, -0.4)
    assert duration_s(-0.4, 0.4, friction=1.3) > 1.15 * duration_s(-0.4, 0.4, friction=0.9)
    assert duration_s(0.4, -0.4, friction=1.3) == pytest.approx(duration_s(0.4, -0.4, friction=0.9), rel=0.02)


@given(joints, joints, st.floats(0.4, 2.5))
def test_no_joint_plans_with_more_than_its_acceleration(q0, q1, friction):
    assert all(0.0 < limit <= ACCELERATION_RADPS2 for limit in accelerations(q0, q1, (friction, friction)))


def believed(tick, q, v, friction=1.0):
    states = tuple(q.tolist()), tuple(v.tolist())
    return ArmBelief(tick * PERIOD_NS, *states, tick * PERIOD_NS, friction=(friction, friction))


def drive(start, goal):
    """Run the controller against joints that follow each command exactly; arguments as in Table 6."""
    (q0, v0), (q1, v1) = start, goal
    arguments = np.array([*np.stack((q0, v0), 1).ravel(), *np.stack((q1, v1), 1).ravel()])
    q, v, state, commands = np.array(q0), np.array(v0), None, []
    for tick in range(200):
        belief = believed(tick, q, v)
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
        control = REACH.controller(state, tick * PERIOD_NS, believed(tick, q, v), arguments)
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


def lift(friction_at):
    """Arrival time of a lift from rest to rest, and how often the motion changed on the way."""
    arguments = np.array([0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.5, 0.0])
    q, v, state, starts = np.array([0.0, -0.5]), np.zeros(2), None, set()
    for tick in range(200):
        control = REACH.controller(state, tick * PERIOD_NS, believed(tick, q, v, friction_at(tick)), arguments)
        state, command = control.state, np.array(control.command)
        starts.add(state.started_ns)
        q, v = q + 0.05 * (v + command), command
        if control.outcome == "done":
            assert math.dist(q, (0.0, 0.5)) < 0.02
            return tick, len(starts)
    raise AssertionError("never arrived")


def test_friction_that_shows_on_the_way_delays_the_waypoint():
    as_usual, colder = lift(lambda tick: 1.0), lift(lambda tick: 1.0 if tick < 4 else 1.5)
    assert as_usual[1] == 1
    assert colder[0] > as_usual[0] + 2


def test_noisy_friction_does_not_make_it_dither():
    noise = np.random.default_rng(2).standard_normal(200)
    assert lift(lambda tick: 1.0 + 0.03 * noise[tick])[1] <= 2
