"""Dead man's switches at the driver: a sender of false promises to repeat it; its silence stops and latches."""

import pytest

from tailor.schemas.messages import ArmRequest, EStop, Sample, VelocityCommand
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit, Mode, Reason

A, B = "a" * 32, "b" * 32
MS = 1_000_000
SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


def arm(by=B, at_ns=0, **changes):
    request = {"arm": True, "reset": False, "sender": "", "epoch": 0, **changes}
    return Sample("agilo/arm_request", ArmRequest(**request), at_ns, 1, by)


def command(v, sequence, at_ns=0):
    return Sample("agilo/cmd_vel", VelocityCommand(0, v, 0.0), at_ns, sequence, A)


def stop(at_ns, sender=B, sequence=1):
    return Sample("estop", EStop(True), at_ns, sequence, sender)


def hold(at_ns, sender=B, sequence=1):
    return Sample("estop", EStop(False), at_ns, sequence, sender)


def counts(driver):
    state = driver.state(10**15, 5)
    return dict(zip(state.refused_reasons, state.refused_counts, strict=True))


def moving(*switches):
    """A driver whose robot moves at t = 0 while people hold switches."""
    driver = Driver(SPEC, 7)
    driver.take([arm(B, sender=A), command(0.5, 1), *(hold(0, sender) for sender in switches)], {}, 0)
    return driver


def drive(driver, from_ms, to_ms, *holders):
    """Commands and held switches at 10 Hz, polled at 100 Hz; the speed after the last period."""
    for at_ms in range(from_ms, to_ms + 10, 10):
        number, now_ns = at_ms // 10 + 2, at_ms * MS
        due = [command(0.5, number, at_ns=now_ns), *(hold(now_ns, s, number) for s in holders)]
        driver.take(due if at_ms % 100 == 0 else [], {}, now_ns)
    return driver.guard.output(now_ns)[0]


@pytest.mark.promise("P45")
def test_a_released_dead_mans_switch_stops_and_latches_after_half_a_second():
    driver = moving(B)
    assert drive(driver, 100, 500) == 0.5
    driver.take([], {}, 500 * MS + 1)
    assert driver.guard.output(500 * MS + 1) == (0.0, 0.0)
    guard = driver.guard
    assert (guard.mode, guard.reason, guard.detail) == (Mode.ESTOPPED, Reason.HOLD_RELEASED, "bbbbbbbb")
    driver.take([arm(B, 510 * MS, sender=A)], {}, 510 * MS)
    assert guard.mode is Mode.ESTOPPED, "only a reset releases it"


@pytest.mark.promise("P45")
def test_a_held_switch_lets_the_robot_drive():
    assert drive(moving(B), 100, 3000, B) == 0.5


@pytest.mark.promise("P45")
def test_one_released_switch_of_several_stops():
    driver = moving(B, "c" * 32)
    assert drive(driver, 100, 500, B) == 0.5
    assert drive(driver, 510, 510, B) == 0.0
    assert driver.guard.detail == "cccccccc"


@pytest.mark.promise("P45")
def test_a_release_wins_over_a_reset_of_the_same_turn_and_over_no_estop():
    driver = moving(B)
    driver.take([arm(B, 501 * MS, sender=A, reset=True)], {}, 501 * MS)
    assert driver.guard.mode is Mode.ESTOPPED
    driver = moving(B)
    driver.take([stop(501 * MS, A), hold(501 * MS, sequence=2)], {}, 501 * MS)
    assert driver.guard.reason is Reason.ESTOP, "a held switch does not take back the stop of another one"
    driver = moving(B)
    driver.take([stop(501 * MS)], {}, 501 * MS)
    assert driver.guard.reason is Reason.ESTOP, "a stop counts more than a release"
    driver = moving(B)
    driver.take([stop(100 * MS)], {}, 100 * MS)
    driver.take([], {}, 700 * MS)
    assert driver.guard.reason is Reason.ESTOP, "the first reason stays"


def test_a_reset_forgets_who_held_a_switch_until_their_next_message():
    driver = moving(B)
    driver.take([stop(100 * MS)], {}, 100 * MS)
    driver.take([arm(B, 200 * MS, sender=A, reset=True)], {}, 200 * MS)
    assert drive(driver, 300, 900) == 0.5
    driver.take([hold(900 * MS, sequence=9)], {}, 900 * MS)
    assert drive(driver, 1000, 1400) == 0.5
    assert drive(driver, 1410, 1410) == 0.0


def test_arming_without_a_latched_estop_forgets_no_switch():
    driver = moving(B)
    driver.take([arm(B, 100 * MS, sender=A, reset=True)], {}, 100 * MS)
    driver.take([arm(B, 200 * MS, arm=False), arm(B, 200 * MS, sender=A)], {}, 200 * MS)
    assert drive(driver, 200, 510) == 0.0


def test_a_recorded_message_does_not_stand_for_a_hand_on_the_switch():
    driver = Driver(SPEC, 7)
    driver.take([hold(0, sequence=5)], {}, 0)
    for sequence in (5, 4):
        driver.take([hold(400 * MS, sequence=sequence)], {}, 400 * MS)
    driver.take([], {}, 501 * MS)
    assert driver.guard.reason is Reason.HOLD_RELEASED
    assert counts(driver) == {"hold: old sequence": 2}


def test_an_unsigned_switch_without_numbers_is_held_too():
    driver = Driver(SPEC, 7)
    for at_ms in range(0, 700, 100):
        driver.take([hold(at_ms * MS, "", 0)], {}, at_ms * MS)
    assert driver.guard.mode is Mode.DISARMED
    driver.take([], {}, 1101 * MS)
    assert driver.guard.reason is Reason.HOLD_RELEASED


def test_more_switches_than_can_be_watched_are_refused_and_counted():
    driver = Driver(SPEC, 7)
    driver.take([hold(0, f"{n:032x}") for n in range(35)], {}, 0)
    assert counts(driver) == {"hold: too many switches": 3}
    assert len(driver.held.senders) == 32


def test_the_state_names_the_switches_that_the_driver_hears():
    driver = moving("c" * 32, B)
    assert driver.state(0, 0).detail == "held by bbbbbbbb, cccccccc"
    driver.take([arm(A, 0, arm=False)], {}, 0)
    assert driver.state(0, 0).detail == "by aaaaaaaa; held by bbbbbbbb, cccccccc"


@pytest.mark.promise("P45")
def test_a_switch_is_held_in_real_time_while_a_simulator_is_paused():
    """The guard's clock stands still then, and runs ahead of real time when a request asks for a minute of steps."""
    driver = moving(B)
    for at_ms in range(10, 60_000, 10):  # the guard's time stays 0
        due = [hold(at_ms * MS, B, at_ms)] if at_ms % 100 == 0 else []
        driver.take(due, {}, at_ms * MS, at_ms * MS)
    assert driver.guard.mode is Mode.ARMED, "held throughout the pause"
    driver.take([], {}, 60_000 * MS, 0)
    assert driver.guard.reason is not Reason.HOLD_RELEASED, "a minute of steps is no minute of silence"
    driver.take([], {}, 60_401 * MS, 60_401 * MS)
    assert driver.guard.reason is Reason.HOLD_RELEASED, "a release counts although the guard's clock stands still"
