"""Joint states that a belief cannot read: they are no measurements, so the arm stands instead of moving blind."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.joint_readings import JointReadings, without_faulty
from tailor.executive.core.modes import Mode
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas.messages import JointState, Sample
from tests.support.toy_domain import LineDomain, driver, line_context, odometry
from tests.unit.executive.core.test_core import TICK, drive

KEY = "agilo/joint_states"
WHOLE = JointState(0, ("pan", "lift"), (0.1, 0.2), (0.0, 0.3), (1.0, 2.0))
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


class Arm(LineDomain):
    """The toy robot, whose joints must be known while it moves."""

    sensors = ("odom", "joint_states")
    required = ("odom", "joint_states")


def known():
    return without_faulty(JointReadings(), {KEY}, (reading(WHOLE),))[0]


@pytest.mark.parametrize(("state", "fault"), FAULTY)
def test_a_joint_state_that_no_belief_can_read_is_no_measurement_and_says_why(state, fault):
    odom = odometry(0, 0.0, 1)
    assert without_faulty(known(), {KEY}, (odom, reading(state))) == (
        JointReadings({KEY: ("pan", "lift")}, {KEY: fault}),
        (odom,),
    )


@pytest.mark.parametrize("state", LEGAL)
def test_joints_in_another_order_or_beside_others_are_read(state):
    after_fault, _ = without_faulty(known(), {KEY}, (reading(FAULTY[0][0]),))
    assert without_faulty(after_fault, {KEY}, (reading(state),)) == (known(), (reading(state),))


def test_a_driver_that_lost_a_joint_while_it_was_restarted_is_not_believed():
    lost = reading(FAULTY[0][0], sender="ef" * 16)
    assert without_faulty(known(), {KEY}, (lost,))[1] == ()


def test_a_first_state_without_joints_names_none():
    readings, samples = without_faulty(JointReadings(), {KEY}, (reading(JointState(0)),))
    assert (readings, samples) == (JointReadings({}, {KEY: "lacks joints"}), ())


def test_joint_states_that_are_no_sensor_of_the_robot_are_not_judged():
    truth = Sample("agilo/sim/joints", FAULTY[0][0], 0, 1, "cd" * 16)
    assert without_faulty(known(), {KEY}, (truth,)) == (known(), (truth,))


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
