"""Stamps of a sender only refuse: none makes a command or a sensor count for more."""

import itertools
from dataclasses import replace

import pytest

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.schemas.messages import ArmRequest, Sample, VelocityCommand
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import CommandRefusal, Limit, Mode
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tailor.tools.lockstep.worlds import make_world

HOUR_NS = 3_600_000_000_000
MS = 1_000_000
CLOCK = 10**18  # the sender's, at our time 0
SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


def driven():
    """A driver that has been moving for 2 s, and a function that sends it a command of another speed and stamp."""
    driver = Driver(SPEC, 7)
    driver.take([Sample("agilo/arm_request", ArmRequest(True, False, "a" * 32, 0), 0, 1, "f" * 32)], {}, 0)

    def send(k, v, ahead_ns=0):
        now_ns = k * 100 * MS
        message = VelocityCommand(CLOCK + now_ns + ahead_ns, v, 0.0)
        driver.take([Sample("agilo/cmd_vel", message, now_ns, k, "a" * 32)], {}, now_ns)
        return driver.guard.output(now_ns)[0]

    for k in range(1, 21):
        assert send(k, 0.5) == 0.5
    return driver, send


@pytest.mark.promise("P24")
def test_a_command_from_the_future_is_refused_and_locks_nobody_out():
    driver, send = driven()
    assert send(21, 0.9, ahead_ns=HOUR_NS) == 0.5
    assert send(22, 0.9, ahead_ns=101 * MS) == 0.5
    assert driver.guard.refused == {CommandRefusal.FROM_THE_FUTURE: 2}
    assert send(23, 0.4) == 0.4


@pytest.mark.promise("P24")
def test_a_sender_whose_clock_jumps_ahead_stops_the_robot():
    driver, send = driven()
    assert [send(21 + k, 0.9, ahead_ns=HOUR_NS) for k in range(4)] == [0.5, 0.5, 0.5, 0.0]
    assert driver.guard.mode is Mode.STOPPED


def run_with(stamped):
    """A run of the soccer robot whose sensors' messages, numbered from 0, `stamped` changes."""
    context = build_context(ExecutiveConfig("soccer", "approach-dribble", Settings()), SENDER)
    world, numbers = make_world("agilo", "approach-dribble", 0), itertools.count()
    return run_lockstep(context, world, transport=lambda message: stamped(next(numbers), message))


def ahead(message, by_ns):
    return replace(message, stamp_ns=message.stamp_ns + by_ns)


@pytest.mark.promise("P24")
def test_a_sensor_whose_clock_is_an_hour_ahead_changes_nothing():
    plain = run_with(lambda _, message: message)
    shifted = run_with(lambda _, message: ahead(message, HOUR_NS))
    assert plain.achieved
    assert (shifted.result, shifted.truth, shifted.status) == (plain.result, plain.truth, plain.status)


@pytest.mark.promise("P24")
def test_single_sensor_messages_from_the_future_are_no_fresher_and_do_no_harm():
    mixed = run_with(lambda number, message: ahead(message, HOUR_NS) if number % 5 == 0 else message)
    assert mixed.achieved
    assert max(abs(truth.v) for truth in mixed.truth) < 1.0
