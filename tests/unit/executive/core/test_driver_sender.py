"""The executive keeps to its driver: a stranger's driver state neither disturbs a run nor keeps it from arming."""

import dataclasses

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.schemas.messages import ArmRequest
from tests.support.toy_domain import driver, line_context, odometry

TICK = 100_000_000
GOAL = "(visited b)"
OURS, STRANGER = "cd" * 16, "ee" * 16


def state_of(sender, now_ns, mode="armed", epoch=7):
    return dataclasses.replace(driver(now_ns, mode, epoch, accepted=0), sender=sender)


def run(context, world, ticks=30):
    """(state, requests) of each tick; `world(n, now_ns)` gives the driver states of a tick in order of arrival."""
    state = initial_state(context)
    for n in range(1, ticks + 1):
        now_ns = n * TICK
        samples = (odometry(now_ns, 0.0, n), *world(n, now_ns))
        state, outputs = step(context, state, now_ns, Inputs(samples, GOAL if n == 1 else ""), CheckBudget(50))
        yield state, [output.message for output in outputs if isinstance(output.message, ArmRequest)]


@pytest.mark.parametrize("mode", ["disarmed", "stopped", "armed"])
def test_a_stranger_beside_the_driver_changes_nothing(mode):
    def disturbed(n, now_ns):
        true = state_of(OURS, now_ns, "disarmed" if n < 3 else "armed")
        return (true, state_of(STRANGER, now_ns, mode, epoch=99)) if n > 1 else (true,)

    def undisturbed(n, now_ns):
        return disturbed(n, now_ns)[:1]

    context = line_context()
    with_stranger, alone = list(run(context, disturbed)), list(run(context, undisturbed))
    assert [s.mode for s, _ in with_stranger] == [s.mode for s, _ in alone]
    assert [r for _, r in with_stranger] == [r for _, r in alone]
    assert with_stranger[-1][0].mode is Mode.EXECUTING


def test_a_driver_that_falls_silent_is_missed_although_a_stranger_speaks():
    def world(n, now_ns):
        true = (state_of(OURS, now_ns),) if n <= 10 else ()
        return (*true, state_of(STRANGER, now_ns, "disarmed", epoch=99))

    states = [state for state, _ in run(line_context(), world)]
    assert states[9].mode is Mode.EXECUTING
    assert states[15].mode is Mode.DISARMED


def test_a_restarted_driver_is_heard_once_the_old_one_is_silent():
    def world(n, now_ns):
        return (state_of(OURS, now_ns) if n <= 10 else state_of(STRANGER, now_ns, epoch=8),) if n != 11 else ()

    states = [state for state, _ in run(line_context(), world)]
    assert states[-1].arming.driver.epoch == 8
    assert states[-1].mode is Mode.EXECUTING, "people have armed it"


def test_an_executive_that_knows_its_driver_is_not_misled_by_the_first_state_that_it_hears():
    def world(n, now_ns):
        return state_of(STRANGER, now_ns, "disarmed", epoch=99), state_of(OURS, now_ns, "disarmed")

    context = dataclasses.replace(line_context(), driver_sender=OURS)
    requests = [request for _, requests in run(context, world) for request in requests]
    assert requests
    assert {request.epoch for request in requests} == {7}
