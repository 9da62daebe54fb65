"""The driver without a bus."""

from dataclasses import replace

import pytest

from tailor.schemas.messages import ArmRequest, EStop, JointCommand, Sample, VelocityCommand
from tailor.simnodes.driver import Driver, command_values
from tailor.simnodes.driver_spec import DriverSpec, shipped_driver_spec
from tailor.simnodes.guard import CommandRefusal, Limit, Mode, Reason

A, B = "a" * 32, "b" * 32
MS = 1_000_000
SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


def arm(by=A, at_ns=0, **changes):
    request = {"arm": True, "reset": False, "sender": "", "epoch": 0, **changes}
    topic = "arm_request" if by == B else "self_arm"  # B is a person
    return Sample(f"agilo/{topic}", ArmRequest(**request), at_ns, 1, by)


def command(v, sequence, sender=A, at_ns=0):
    return Sample("agilo/cmd_vel", VelocityCommand(0, v, 0.0), at_ns, sequence, sender)


def stop(at_ns, sender=B, sequence=1):
    return Sample("estop", EStop(True), at_ns, sequence, sender)


def hold(at_ns, sender=B, sequence=1):
    return Sample("estop", EStop(False), at_ns, sequence, sender)


def test_an_arming_request_without_a_sender_arms_its_own_sender():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A), command(0.5, 1, A, 1)], {}, 1)
    assert driver.guard.output(1) == (0.5, 0.0)


def test_a_program_that_arms_itself_is_refused_without_leave():
    driver = Driver(SPEC, 7)
    for name in ("", A):
        driver.take([arm(A, sender=name, reset=True), command(0.5, 1, A, 1)], {}, 1)
        assert driver.guard.output(1) == (0.0, 0.0)


def test_a_program_cannot_use_the_leave_of_another():
    driver = Driver(SPEC, 7, leave=A)
    stranger = Sample("agilo/self_arm", ArmRequest(True, False, A, 0), 0, 1, "c" * 32)
    driver.take([stranger, command(0.5, 1, A)], {}, 0)
    assert (driver.guard.mode, driver.guard.output(0)) == (Mode.DISARMED, (0.0, 0.0))
    driver.take([arm(A)], {}, 0)
    assert driver.guard.sender == A, "it is not spent"


@pytest.mark.promise("P38")
def test_an_estop_wins_over_an_arming_request_that_was_sent_after_it():
    driver = Driver(SPEC, 7)
    driver.take([arm(B, sender=A)], {}, 0)
    stop = Sample("estop", EStop(True), 5 * MS, 1, B)
    driver.take([stop, arm(B, 10 * MS, sender=A, reset=True)], {}, 10 * MS)
    assert driver.guard.mode is Mode.ESTOPPED


def test_a_person_may_arm_the_executive():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(B, sender=A), command(0.5, 1, A, 1)], {}, 1)
    assert driver.guard.sender == A


@pytest.mark.promise("P38")
def test_an_estop_beats_everything_that_arrives_with_it():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A)], {}, 0)
    driver.take([command(0.5, 1), arm(A, 1), Sample("estop", EStop(True), 2, 1, B)], {}, 2)
    assert driver.guard.mode is Mode.ESTOPPED
    assert driver.guard.output(2) == (0.0, 0.0)
    driver.take([hold(3, sequence=2)], {}, 3)
    assert driver.guard.mode is Mode.ESTOPPED, "an e-stop of false does not release"


def test_disarming_names_the_sender_and_respects_the_epoch():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A)], {}, 0)
    driver.take([arm(B, arm=False, epoch=6)], {}, 0)
    assert driver.guard.mode is Mode.ARMED
    driver.take([arm(B, arm=False, epoch=7)], {}, 0)
    assert (driver.guard.mode, driver.guard.reason) == (Mode.DISARMED, Reason.DISARM_REQUEST)
    assert driver.guard.detail == "by bbbbbbbb"


def test_a_request_to_disarm_any_start_of_the_driver_is_obeyed():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A), command(0.5, 1, A, 1)], {}, 1)
    driver.take([arm(B, 2, arm=False, epoch=0)], {}, 2)
    assert (driver.guard.mode, driver.guard.output(2)) == (Mode.DISARMED, (0.0, 0.0))


def test_requests_count_in_the_order_of_their_arrival():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(B, 2, arm=False), arm(B, 1, sender=A)], {}, 2)
    assert driver.guard.mode is Mode.DISARMED
    driver.take([arm(B, 4, sender=A), arm(B, 3, arm=False)], {}, 4)
    assert driver.guard.mode is Mode.ARMED


def test_an_estop_message_that_stops_nobody_leaves_no_trace():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A), command(0.5, 1, A, 1), Sample("estop", EStop(False), 1, 1, B)], {}, 1)
    assert (driver.guard.mode, driver.guard.output(1)) == (Mode.ARMED, (0.5, 0.0))


def test_a_command_is_as_old_as_its_arrival_when_the_driver_takes_it_late():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A)], {}, 0)
    driver.take([command(0.5, 1, A, 100 * MS)], {}, 300 * MS)
    assert driver.guard.output(400 * MS) == (0.5, 0.0)
    assert driver.guard.output(400 * MS + 1) == (0.0, 0.0)


def test_the_stamp_of_a_command_lets_the_guard_refuse_a_delayed_one():
    driver = Driver(SPEC, 7, leave=A)
    delayed = [
        Sample("agilo/cmd_vel", VelocityCommand(stamp_ns, v, 0.0), at_ns, k, A)
        for k, (stamp_ns, v, at_ns) in enumerate(
            [(50 * MS, 0.5, 0), (150 * MS, 0.4, 250 * MS), (160 * MS, 0.3, 511 * MS)]
        )
    ]
    driver.take([arm(A), *delayed[:2]], {}, 250 * MS)
    assert driver.guard.output(250 * MS) == (0.4, 0.0)
    assert driver.state(250 * MS, 5).command_stamp_ns == 150 * MS
    driver.take(delayed[2:], {}, 511 * MS)
    assert driver.guard.output(511 * MS) == (0.4, 0.0)
    assert driver.guard.refused == {CommandRefusal.LATE: 1}


def test_the_state_is_published_at_10_hz_and_on_change():
    driver = Driver(SPEC, 7, leave=A)
    assert driver.state(0, 5).mode == "disarmed"
    assert driver.state(99 * MS, 5) is None
    assert driver.state(100 * MS, 5) is not None
    driver.take([arm(A, at_ns=110 * MS)], {}, 110 * MS)
    state = driver.state(110 * MS, 5)
    assert (state.mode, state.epoch, state.armed_sender) == ("armed", 7, A)


def counts(driver):
    state = driver.state(10**15, 5)
    return dict(zip(state.refused_reasons, state.refused_counts, strict=True))


def test_the_state_counts_refusals_and_undecodable_bytes():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([command(0.5, 1)], {"malformed": 3}, 0)
    assert counts(driver) == {"not armed": 1, "malformed": 3}


def test_the_state_counts_refused_arming_requests_by_reason():
    driver = Driver(SPEC, 7)
    driver.take([arm(A), arm(B, sender=A, epoch=6), arm(B, arm=False, epoch=6), arm("", sender="")], {}, 0)
    assert counts(driver) == {"arm: only people may arm": 1, "arm: other epoch": 2, "arm: no sender": 1}
    driver.take([stop(0), arm(B, 0, sender=A, reset=True)], {}, 0)
    assert counts(driver)["arm: e-stop is latched"] == 1


def test_a_message_that_is_no_command_never_moves_the_robot():
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A)], {}, 0)
    driver.take([Sample("agilo/cmd_vel", EStop(False), 0, 1, A), Sample("x", None, 0, 2, A)], {}, 0)
    assert driver.guard.output(0) == (0.0, 0.0)


def test_joint_commands_are_matched_by_name():
    command = JointCommand(0, ("elbow", "wrist"), (0.1, 0.2))
    assert command_values(command, ("wrist", "elbow")) == (0.2, 0.1)
    assert command_values(command, ("wrist", "elbow", "base")) == ()
    assert command_values(command, ("wrist", "base")) == ()
    assert command_values(JointCommand(0, ("elbow", "wrist"), (0.1,)), ("wrist", "elbow")) == (0.1,)


def test_agilo_declares_its_limits_and_the_time_out():
    declared = shipped_driver_spec("agilo")
    command = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-0.9, 0.9), Limit(-1.75, 1.75)))
    assert replace(declared, sensors=()) == command
    assert [sensor.topic for sensor in declared.sensors] == ["odom", "pose", "ball", "opponents", "ball2"]


def test_a_paused_simulator_takes_no_command_for_one_from_the_future():
    """The guard's clock falls behind while the world stands; stamps are judged in real time."""
    driver = Driver(SPEC, 7, leave=A)
    driver.take([arm(A)], {}, 0)
    for number in (*range(1, 30), *range(31, 41)):  # 4 s, paused after two; one command is lost
        now_ns, lag_ns = number * 100 * MS, min(max(0, number - 20), 20) * 100 * MS
        sample = Sample("agilo/cmd_vel", VelocityCommand(now_ns, 0.5, 0.0), now_ns, number, A)
        driver.take([sample], {}, now_ns, lag_ns)
    assert (driver.guard.accepted, dict(driver.guard.refused)) == (39, {})


def test_changes_in_quick_succession_do_not_silence_the_state():
    """Each published at once moved the next one by a period: after twenty changes nothing was heard for two seconds."""
    driver, published_ms = Driver(SPEC, 7), []
    for period in range(31):
        now_ns = (1000 + 10 * period) * MS
        driver.unready = f"step {period}" if period < 20 else ""
        if driver.state(now_ns, now_ns) is not None:
            published_ms.append(10 * period)
    assert published_ms == [*range(0, 210, 10), 300]


def test_a_number_of_a_notice_that_always_changes_is_published_with_the_next_state():
    """A battery's voltage, read a hundred times a second, was published as often."""
    driver, published = Driver(SPEC, 7), []
    for period in range(30):
        now_ns = (1000 + 10 * period) * MS
        driver.notice = f"battery low: 23.{period:02d} V" if period >= 15 else "battery at 24.0 V"
        state = driver.state(now_ns, now_ns)
        if state is not None:
            published.append((10 * period, state.detail))
    low = ["battery at 24.0 V"] * 2 + ["battery low: 23.15 V", "battery low: 23.20 V"]
    assert published == list(zip((0, 100, 150, 200), low, strict=True))


@pytest.mark.parametrize(
    ("fault", "unready", "detail"),
    [
        ("read: OSError", "read: OSError", "read: OSError; not ready"),
        ("read: OSError", "opening", "read: OSError; not ready: opening"),
        ("read: OSError", "", "read: OSError"),
        ("", "opening", "not ready: opening"),
        ("", "", ""),
    ],
)
def test_the_state_tells_a_fault_that_lasts_from_one_that_is_over(fault, unready, detail):
    """Arming is refused while it lasts; the reason of the stop stays until a person arms."""
    driver = Driver(SPEC, 7)
    if fault:
        driver.guard.stop(fault)
    driver.unready = unready
    assert driver.state(0, 0).detail == detail
