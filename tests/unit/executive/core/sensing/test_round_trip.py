"""Age of the command that a driver's state echoes: too old, the robot holds; by the executive's own clock alone."""

from dataclasses import replace

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.sensing.freshness import MAX_ROUND_TRIP_NS, echo_age_ns
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas.messages import VelocityCommand
from tests.support.toy_domain import driver, line_context, odometry

TICK = 100_000_000
MS = 1_000_000
GOAL = "(and (visited a) (visited b) (at b))"
LATE = Cause(Reason.ROUND_TRIP, "751 ms, limit 750 ms")


def echo(arrival_ns, stamp_ns):
    """A driver state that echoes a command of that stamp; 0: none."""
    sample = driver(arrival_ns)
    return replace(sample, message=replace(sample.message, command_stamp_ns=stamp_ns))


def driven(age_ms, offset_ns=0, ticks=30):
    """(state, commanded speed, None without a command) of each tick; `age_ms(n)` is the age of the echo, None: none."""
    context = replace(line_context(), stamp_offset_ns=offset_ns)
    state, x, run = initial_state(context), 0.0, []
    for n in range(1, ticks + 1):
        arrival_ns, age = n * TICK - 7 * MS, age_ms(n)
        stamp_ns = 0 if age is None else arrival_ns + offset_ns - age * MS
        given = Inputs((odometry(n * TICK, x, n), echo(arrival_ns, stamp_ns)), GOAL if n == 1 else "")
        state, outputs = step(context, state, n * TICK, given, CheckBudget(200))
        x += 0.1 * state.command[0]
        commands = [output.message.v for output in outputs if isinstance(output.message, VelocityCommand)]
        run.append((state, commands[0] if commands else None))
    return run


@pytest.mark.promise("P13")
def test_the_age_of_an_echo_counts_from_the_senders_stamp_to_its_arrival():
    assert MAX_ROUND_TRIP_NS == 750 * MS
    state = echo(0, 5_000 * MS).message
    assert echo_age_ns(state, 6_000 * MS, 0) == 1_000 * MS
    assert echo_age_ns(state, 1_000 * MS, 4_500 * MS) == 500 * MS
    assert echo_age_ns(echo(0, 0).message, 6_000 * MS, 0) == 0


@pytest.mark.promise("P13")
@pytest.mark.parametrize("offset_ns", [0, 10**18])
def test_the_robot_holds_while_the_round_trip_is_too_long_and_keeps_its_plan(offset_ns):
    run = driven(lambda n: 751 if 10 <= n < 20 else 750, offset_ns)
    held = [state.mode is Mode.HOLDING for state, _ in run]
    assert held == [10 <= n < 20 for n in range(1, 31)]
    assert [command for _, command in run[9:19]] == [0.0] * 10, "zero commands go on, so that the echo recovers"
    assert run[9][0].cause == LATE
    assert run[18][0].task.plan is not None
    assert all(run[n][1] > 0 for n in (8, 21)), "motion goes on by itself"


@pytest.mark.promise("P13")
def test_a_driver_that_echoes_nothing_is_not_judged():
    run = driven(lambda n: None)
    assert run[8][0].mode is Mode.EXECUTING
    assert run[8][1] > 0


def test_an_echo_that_is_too_old_holds_until_another_state_arrives():
    context = line_context()
    state, _ = step(context, initial_state(context), TICK, Inputs((echo(TICK, 0),), GOAL), CheckBudget(200))
    late = Inputs((odometry(10 * TICK, 0.0, 10), echo(10 * TICK, 10 * TICK - 751 * MS)))
    state, _ = step(context, state, 10 * TICK, late, CheckBudget(200))
    state, _ = step(context, state, 11 * TICK, Inputs((odometry(11 * TICK, 0.0, 11),)), CheckBudget(200))
    assert (state.mode, state.cause) == (Mode.HOLDING, LATE)
