"""Several command outlets behind one guard: their parts are one command, and what stops one stops all."""

from __future__ import annotations

import dataclasses

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.schemas.messages import ArmRequest, EStop, JointCommand, Sample, VelocityCommand
from tailor.simnodes.command_parts import MAX_WAITING, CommandParts, Joined, Part
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import OutletSpec, read_driver_spec
from tailor.simnodes.guard import TIMEOUT_NS, CommandRefusal, Mode, Reason

A, B = "a" * 32, "b" * 32
MS = 1_000_000
BASE_AND_ARM = """
[[commands]]
topic = "cmd_vel"
timeout_s = 0.3
axes = [
  { name = "v", unit = "m/s", lower = -1.0, upper = 1.0 },
  { name = "omega", unit = "rad/s", lower = -2.0, upper = 2.0 },
]
[[commands]]
topic = "joint_cmd"
timeout_s = 0.3
axes = [
  { name = "lift", unit = "rad/s", lower = -1.0, upper = 1.0 },
  { name = "grip", unit = "m", lower = 0.01, upper = 0.08, kept = 0.05 },
]
"""
SPEC = read_driver_spec(BASE_AND_ARM)
REST = (0.0, 0.0, 0.0, 0.05)


def base(v, sequence, sender=A, at_ns=0):
    return Sample("robot/cmd_vel", VelocityCommand(0, v, 0.5), at_ns, sequence, sender)


def arm(lift, sequence, sender=A, at_ns=0, grip=0.02):
    return Sample("robot/joint_cmd", JointCommand(0, ("lift", "grip"), (lift, grip)), at_ns, sequence, sender)


def armed() -> Driver:
    driver = Driver(SPEC, 7, leave=A)
    driver.take([Sample("robot/self_arm", ArmRequest(True, False, "", 0), 0, 1, A)], {}, 0)
    assert driver.guard.mode is Mode.ARMED
    return driver


def test_both_outlets_have_topics_axes_and_limits_of_their_own():
    assert SPEC.command_topics == ("cmd_vel", "joint_cmd")
    assert SPEC.all_outlets()[1] == OutletSpec("joint_cmd", ("lift", "grip"))
    assert SPEC.axes == ("v", "omega", "lift", "grip")
    assert [limit.kept for limit in SPEC.limits] == [None, None, None, 0.05]


def test_a_command_topic_that_the_outlets_leave_unused_is_refused():
    with pytest.raises(ValueError, match="command_topic is grip, expected cmd_vel"):
        dataclasses.replace(SPEC, command_topic="grip")


def test_one_outlet_alone_moves_nothing():
    driver = armed()
    driver.take([base(0.4, 1)], {}, 0)
    assert driver.guard.output(0) == REST


def test_parts_of_one_number_are_one_command_in_either_order():
    for samples in ([base(0.4, 1), arm(0.3, 1)], [arm(0.3, 1), base(0.4, 1)]):
        driver = armed()
        driver.take(samples, {}, 0)
        assert driver.guard.output(0) == (0.4, 0.5, 0.3, 0.02)
        assert driver.guard.accepted == 1


def test_parts_of_one_command_may_arrive_in_two_periods():
    driver = armed()
    driver.take([base(0.4, 1)], {}, 0)
    driver.take([arm(0.3, 1, at_ns=5 * MS)], {}, 5 * MS)
    assert driver.guard.output(5 * MS) == (0.4, 0.5, 0.3, 0.02)


def test_parts_of_two_numbers_are_no_command():
    driver = armed()
    driver.take([base(0.4, 1), arm(0.3, 2)], {}, 0)
    assert driver.guard.output(0) == REST


@pytest.mark.parametrize("silent", ["base", "arm"])
def test_silence_of_one_outlet_stops_all(silent):
    driver = armed()
    driver.take([base(0.4, 1), arm(0.3, 1)], {}, 0)
    for tick in range(1, 5):
        at_ns = tick * 100 * MS
        part = arm(0.3, tick + 1, at_ns=at_ns) if silent == "base" else base(0.4, tick + 1, at_ns=at_ns)
        driver.take([part], {}, at_ns)
        assert driver.guard.output(at_ns)[0] == (0.4 if at_ns <= TIMEOUT_NS else 0.0)
    assert driver.guard.reason is Reason.COMMAND_TIMEOUT
    assert driver.guard.output(at_ns) == (0.0, 0.0, 0.0, 0.02)


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (arm(1.2, 2), CommandRefusal.BEYOND_LIMIT),
        (arm(float("nan"), 2), CommandRefusal.NOT_FINITE),
        (Sample("robot/joint_cmd", JointCommand(0, ("lift",), (0.1,)), 0, 2, A), CommandRefusal.WRONG_COUNT),
        (arm(0.1, 2, grip=0.0), CommandRefusal.BEYOND_LIMIT),
    ],
)
def test_a_part_that_is_refused_lets_no_other_part_pass(bad, reason):
    driver = armed()
    driver.take([base(0.4, 1), arm(0.3, 1)], {}, 0)
    driver.take([base(0.9, 2), bad], {}, 0)
    assert driver.guard.output(0) == (0.4, 0.5, 0.3, 0.02)
    assert driver.guard.refused == {reason: 1}


def test_an_estop_stops_all_axes_and_the_gripper_keeps_its_width():
    driver = armed()
    driver.take([base(0.4, 1), arm(0.3, 1)], {}, 0)
    driver.take([Sample("estop", EStop(True), 1, 1, B)], {}, 1)
    assert driver.guard.output(1) == (0.0, 0.0, 0.0, 0.02)
    driver.take([base(0.4, 2), arm(0.3, 2, grip=0.07)], {}, 2)
    assert driver.guard.output(2) == (0.0, 0.0, 0.0, 0.02)


def test_parts_of_two_senders_are_never_joined():
    driver = armed()
    driver.take([base(0.4, 1), arm(0.9, 1, sender=B)], {}, 0)
    assert driver.guard.output(0) == REST
    assert driver.guard.refused == {CommandRefusal.OTHER_SENDER: 1}
    driver.take([arm(0.3, 1)], {}, 0)
    assert driver.guard.output(0) == (0.4, 0.5, 0.3, 0.02)


def test_parts_from_before_arming_are_not_joined_with_later_ones():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([base(0.9, 1)], {}, 0)
    driver.take([Sample("robot/self_arm", ArmRequest(True, False, "", 0), 1, 1, A), arm(0.3, 1, at_ns=2)], {}, 2)
    assert driver.guard.output(2) == REST


def test_another_sender_that_is_obeyed_ends_the_wait_for_parts_of_the_one_before():
    parts = CommandParts((1, 1))
    assert parts.join(Part(0, 1, (0.9,), 0), A, armed_sender=A) == []
    assert parts.join(Part(1, 1, (0.3,), 0), B, armed_sender=B) == []
    assert parts.join(Part(0, 1, (0.4,), 0), B, armed_sender=B) == [Joined(1, (0.4, 0.3))]


@pytest.mark.promise("P14")
@pytest.mark.parametrize("stop", ["disarmed", "e-stop", "silence"])
def test_parts_from_before_a_stop_are_not_joined_with_those_after_arming_again(stop):
    """A minute old, and taken for as young as the part that completed it: the first command since arming."""
    driver, minute_ns = armed(), 60_000 * MS
    driver.take([base(0.9, 1)], {}, 0)
    stops = {"disarmed": ("robot/arm_request", ArmRequest(False, False, "", 0)), "e-stop": ("estop", EStop(True))}
    driver.take([Sample(*stops[stop], 1, 1, B)] if stop in stops else [], {}, 1)
    again = Sample("robot/arm_request", ArmRequest(True, True, A, 0), minute_ns, 2, B)
    driver.take([again, arm(0.3, 1, at_ns=minute_ns)], {}, minute_ns)
    assert driver.guard.mode is Mode.ARMED
    assert driver.guard.output(minute_ns) == REST


def test_a_request_to_arm_that_is_repeated_while_armed_costs_no_command():
    driver = armed()
    driver.take([base(0.4, 1)], {}, 0)
    driver.take([Sample("robot/arm_request", ArmRequest(True, False, A, 0), 1, 1, B), arm(0.3, 1, at_ns=2)], {}, 2)
    assert driver.guard.output(2) == (0.4, 0.5, 0.3, 0.02)


def test_the_first_part_of_a_number_counts():
    driver = armed()
    driver.take([base(0.4, 1), base(1.0, 1), arm(0.3, 1)], {}, 0)
    assert driver.guard.output(0) == (0.4, 0.5, 0.3, 0.02)


def test_numbers_that_never_complete_neither_grow_memory_nor_lock_the_sender_out():
    driver = armed()
    for sequence in range(1000, 1000 + 5 * MAX_WAITING):
        driver.take([base(0.9, sequence)], {}, 0)
    driver.take([base(0.4, 1), arm(0.3, 1)], {}, 0)
    assert driver.guard.output(0) == (0.4, 0.5, 0.3, 0.02)
    assert driver.guard.refused == {CommandRefusal.WRONG_COUNT: 4 * MAX_WAITING + 1}


def test_a_value_too_many_in_one_part_does_not_make_up_for_one_too_few_in_another():
    parts = CommandParts([2, 2])
    assert parts.join(Part(0, 1, (0.1,), 0), A, A) == []
    assert parts.join(Part(1, 1, (0.1, 0.2, 0.3), 0), A, A) == [Joined(1)]


def test_the_stamp_of_a_command_is_that_of_its_oldest_part():
    parts = CommandParts([1, 1])
    parts.join(Part(0, 1, (0.1,), 20), A, A)
    assert parts.join(Part(1, 1, (0.2,), 10), A, A) == [Joined(1, (0.1, 0.2), 10)]


@given(st.lists(st.tuples(st.booleans(), st.integers(1, 6), st.sampled_from([A, B])), max_size=40))
def test_output_is_always_rest_or_one_command_of_the_armed_sender(arrivals):
    """Each part carries its number as its value, so that a mixture of two commands would show."""
    driver = armed()
    for is_base, number, sender in arrivals:
        part = base(number / 10, number, sender) if is_base else arm(number / 10, number, sender)
        driver.take([part], {}, 0)
        v, _, lift, _ = driver.guard.output(0)
        assert v == lift


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (BASE_AND_ARM.replace('"lift"', '"v"'), "v: declared twice"),
        (BASE_AND_ARM.replace('"joint_cmd"', '"cmd_vel"'), "cmd_vel: declared twice"),
        (BASE_AND_ARM.replace("kept = 0.05", "kept = 0.5"), "grip is kept at 0.5"),
        (
            BASE_AND_ARM.replace(
                'timeout_s = 0.3\naxes = [\n  { name = "lift"', 'timeout_s = 3.0\naxes = [\n  { name = "lift"'
            ),
            "timeout_s is 3",
        ),
    ],
)
def test_contradictory_declaration_is_refused(text, fault):
    with pytest.raises(ValueError, match=fault):
        read_driver_spec(text)
