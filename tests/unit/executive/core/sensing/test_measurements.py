"""Messages that no belief can use are no measurements, so the robot stands instead of moving blind."""

from __future__ import annotations

import dataclasses
import math

import pytest

from tailor.executive import domains
from tailor.executive.core.modes import Mode
from tailor.executive.core.perception import perceive
from tailor.executive.core.sensing.measurements import Measurements, fastest_of, without_faulty
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.interfaces.domain import Axis
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas.messages import JointState, Odometry, PoseEstimate, Sample
from tests.support.toy_domain import LineDomain, driver, line_context, odometry
from tests.unit.executive.core.test_core import TICK, drive

KEY = "agilo/joint_states"
WHOLE = JointState(0, ("pan", "lift"), (0.1, 0.2), (0.0, 0.03), (1.0, 2.0))
FAULTY = [
    (JointState(0, ("pan",), (0.1,), (0.0,), (1.0,)), "lacks lift"),
    (JointState(0, ("lift", "hand"), (0.1, 0.2), (0.0, 0.3), (1.0, 2.0)), "lacks pan"),
    (JointState(0), "lacks pan"),
    (JointState(0, ("pan", "lift", "pan"), (0.1, 0.2, 0.5), (0.0, 0.3, 0.1), (1.0, 2.0, 0.0)), "has pan twice"),
    (dataclasses.replace(WHOLE, positions=(0.1, -1.1e6)), "has lift at -1.1e+06"),
    (dataclasses.replace(WHOLE, velocities=(1001.0, 0.0)), "has pan at 1001"),
]
LEGAL = [
    JointState(0, ("lift", "pan"), (0.2, 0.1), (0.3, 0.0), (2.0, 1.0)),
    JointState(0, ("pan", "hand", "lift"), (0.1, 0.0, 0.2), (0.0, 0.0, 0.3), (1.0, 0.0, 2.0)),
    dataclasses.replace(WHOLE, positions=(1e6, -1e6), velocities=(1e3, -1e3)),
]


def reading(state, now_ns=0, number=0, sender="cd" * 16):
    return Sample(KEY, state, now_ns, number, sender)


STILL = Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0)
HERE = PoseEstimate(0, 0.0, 0.0, 0.0, 0.1, 0.1, 0.1)
IMPOSSIBLE = [
    ("odom", dataclasses.replace(STILL, v=-1.01), "has v at -1.01"),
    ("odom", dataclasses.replace(STILL, omega=2.01), "has omega at 2.01"),
    ("odom", dataclasses.replace(STILL, v=math.nan), "has v at nan"),  # a simulator in this process decodes nothing
    ("pose", dataclasses.replace(HERE, x=-1.1e8), "has x at -1.1e+08"),
    ("pose", dataclasses.replace(HERE, y=1.1e8), "has y at 1.1e+08"),
]
POSSIBLE = [
    ("odom", dataclasses.replace(STILL, x=1e12, v=-1.0, omega=2.0)),
    ("pose", dataclasses.replace(HERE, x=1e8, y=-1e8)),
]


class Arm(LineDomain):
    """The toy robot, whose joints must be known while it moves."""

    sensors = ("odom", "joint_states")
    required = ("odom", "joint_states")


class Backward(LineDomain):
    """The toy robot, if it is faster backward than forward."""

    axes = (Axis("v", "m/s", -0.75, 0.25),)


def known():
    return without_faulty(Measurements(), (reading(WHOLE),))[0]


@pytest.mark.parametrize(("state", "fault"), FAULTY)
def test_a_joint_state_that_no_belief_can_read_is_no_measurement_and_says_why(state, fault):
    odom = odometry(0, 0.0, 1)
    assert without_faulty(known(), (odom, reading(state))) == (
        dataclasses.replace(known(), joints={KEY: ("pan", "lift")}, faults={KEY: fault}),
        (odom,),
    )


@pytest.mark.parametrize("state", LEGAL)
def test_joints_in_another_order_or_beside_others_are_read(state):
    after_fault, _ = without_faulty(known(), (reading(FAULTY[0][0]),))
    after, samples = without_faulty(after_fault, (reading(state),))
    assert (after.joints, after.faults, samples) == (known().joints, known().faults, (reading(state),))


def test_a_driver_that_lost_a_joint_while_it_was_restarted_is_not_believed():
    lost = reading(FAULTY[0][0], sender="ef" * 16)
    assert without_faulty(known(), (lost,))[1] == ()


def test_a_first_state_without_joints_names_none():
    readings, samples = without_faulty(Measurements(), (reading(JointState(0)),))
    assert (readings, samples) == (Measurements({}, {KEY: "lacks joints"}), ())


@pytest.mark.parametrize("state", [WHOLE, FAULTY[0][0]])
def test_joint_states_that_are_no_sensor_of_the_robot_are_not_judged(state):
    truth = Sample("agilo/sim/joints", state, TICK, 1, "cd" * 16)
    samples = (odometry(TICK, 0.0, 1), reading(WHOLE, TICK, 1), driver(TICK), truth)
    context = dataclasses.replace(line_context(), domain=Arm())
    after = perceive(context, initial_state(context), TICK, Inputs(samples))
    assert (after.measurements.joints, after.measurements.faults) == (known().joints, known().faults)
    assert set(after.arrivals) == set(after.streams) == {"agilo/odom", KEY}


@pytest.mark.promise("P6")
@pytest.mark.parametrize(("state", "fault"), FAULTY)
def test_an_arm_whose_joint_states_lose_a_joint_stands_until_they_are_whole(state, fault):
    def world(n, given, x):
        joints = reading(state if 5 < n <= 20 else WHOLE, n * TICK, 5 * n)
        return dataclasses.replace(given, samples=(odometry(n * TICK, x, n), joints, driver(n * TICK)))

    context = dataclasses.replace(line_context(), domain=Arm())
    run = list(drive(context, world=world, ticks=60))
    states = [state for state, _, _ in run]
    assert {s.mode for s in states[5:10]} == {Mode.EXECUTING}, "a pause within the limit of freshness stops nobody"
    assert {s.mode for s in states[10:20]} == {Mode.HOLDING}
    assert {s.cause for s in states[10:20]} == {Cause(Reason.INPUT_STALE, f"joint_states {fault}")}
    assert all(s.command == (0.0,) for s in states[10:20])
    assert all(state.command != (0.0,) for state in states[5:10])
    assert states[-1].task.result == "achieved"


def joints_at(n, frozen, velocity=0.5):
    """Joint states of a lift that moves in each tick, and from the tick `frozen` on are repeated with new stamps."""
    at = min(n, frozen)
    return reading(JointState(n * TICK, ("pan", "lift"), (0.1, 0.01 * at), (0.0, velocity), ()), n * TICK, 5 * n)


@pytest.mark.promise("P6")
def test_an_arm_whose_encoders_are_frozen_in_motion_stands_until_they_are_not():
    def world(n, given, x):
        joints = joints_at(n, 8 if n <= 30 else 100)
        return dataclasses.replace(given, samples=(odometry(n * TICK, x, n), joints, driver(n * TICK)))

    context = dataclasses.replace(line_context(), domain=Arm())
    states = [state for state, _, _ in drive(context, world=world, ticks=70)]
    fault = Cause(Reason.INPUT_STALE, "joint_states repeats itself while its joints move at 0.5")
    assert states[9].mode is Mode.EXECUTING
    assert {(s.mode, s.cause, s.command) for s in states[16:30]} == {(Mode.HOLDING, fault, (0.0,))}
    assert states[-1].task.result == "achieved"


@pytest.mark.parametrize(("frozen", "velocity"), [(0, 0.1), (0, 0.0), (100, 0.5)])
def test_joints_at_rest_may_repeat_themselves_for_ever_and_moving_ones_keep_their_velocities(frozen, velocity):
    known = Measurements()
    for n in range(100):
        sample = joints_at(n, frozen, velocity)
        known, kept = without_faulty(known, (sample,))
        assert (kept, known.faults) == ((sample,), {})


def test_a_silence_is_no_motion_of_joints():
    first, later = joints_at(1, 0), dataclasses.replace(joints_at(1, 0), arrival_ns=90 * TICK)
    assert without_faulty(without_faulty(Measurements(), (first,))[0], (later,))[0].faults == {}


@pytest.mark.promise("P6")
def test_no_second_sender_takes_the_place_of_one_whose_joint_states_lost_a_joint():
    """Another robot's joints, as of a simulator that was started twice."""

    def world(n, given, x):
        first = reading(WHOLE if n <= 5 else FAULTY[0][0], n * TICK, 5 * n)
        second = reading(WHOLE, n * TICK, 5 * n, "ef" * 16)
        samples = (odometry(n * TICK, x, n), second, first) if n > 1 else (odometry(n * TICK, x, n), first)
        return dataclasses.replace(given, samples=(*samples, driver(n * TICK)))

    context = dataclasses.replace(line_context(), domain=Arm())
    states = [state for state, _, _ in drive(context, world=world, ticks=40)]
    assert {s.mode for s in states[12:]} == {Mode.HOLDING}


@pytest.mark.parametrize(("topic", "message", "fault"), IMPOSSIBLE)
def test_motion_and_places_that_no_robot_has_are_no_measurements(topic, message, fault):
    key = f"agilo/{topic}"
    sample = Sample(key, message, 0, 1, "cd" * 16)
    assert without_faulty(Measurements(), (sample,), (1.0, 2.0)) == (Measurements({}, {key: fault}), ())


@pytest.mark.parametrize(("topic", "message"), POSSIBLE)
def test_what_a_robot_may_do_is_a_measurement(topic, message):
    key = f"agilo/{topic}"
    sample = Sample(key, message, 0, 1, "cd" * 16)
    known, kept = without_faulty(Measurements({}, {key: "has v at 9"}), (sample,), (1.0, 2.0))
    assert (known.joints, known.faults, kept) == ({}, {}, (sample,))


def test_odometry_of_a_robot_without_velocity_commands_is_not_judged():
    sample = Sample("agilo/odom", dataclasses.replace(STILL, v=1e9), 0, 1, "cd" * 16)
    assert without_faulty(Measurements(), (sample,), None) == (Measurements(), (sample,))


@pytest.mark.parametrize(
    ("domain", "expected"),
    [
        (domains.load("kitchen"), (1.6 * 0.6 + 0.05, 1.6 * 1.0 + 0.05)),
        (domains.load("arm"), None),
        (LineDomain(), (1.6 * 0.5 + 0.05, math.inf)),
        (Backward(), (1.6 * 0.75 + 0.05, math.inf)),
    ],
)
def test_odometry_may_be_faster_than_the_commands_by_a_margin(domain, expected):
    fastest = fastest_of(domain)
    assert fastest == (pytest.approx(expected) if expected else None)


@pytest.mark.promise("P6")
def test_a_robot_whose_odometry_is_impossible_stands_until_it_is_not():
    def world(n, given, x):
        odom = odometry(n * TICK, x, n)
        if 5 < n <= 20:
            odom = dataclasses.replace(odom, message=dataclasses.replace(odom.message, v=1e14))
        return dataclasses.replace(given, samples=(odom, driver(n * TICK)))

    states = [state for state, _, _ in drive(line_context(), world=world, ticks=60)]
    assert {s.mode for s in states[5:10]} == {Mode.EXECUTING}
    assert {s.cause for s in states[10:20]} == {Cause(Reason.INPUT_STALE, "odom has v at 1e+14")}
    assert all(s.command == (0.0,) for s in states[10:20])
    assert states[-1].task.result == "achieved"
