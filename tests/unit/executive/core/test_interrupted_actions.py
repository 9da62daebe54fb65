"""An action that people or the driver end is reported as every other end: nothing joins it with what comes after."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.state import Inputs
from tailor.schemas.messages import ActionFinished, ExecStatus
from tests.support.toy_domain import driver, line_context, odometry
from tests.unit.executive.core.test_core import TICK, drive, messages

DISARM_DETAIL = "driver not armed: disarmed"


def disarmed(n, given, x):
    return Inputs((odometry(n * TICK, x, n), driver(n * TICK, "disarmed" if 6 <= n < 9 else "armed")), given.goal)


def new_goal(n, given, x):
    return dataclasses.replace(given, goal="(visited b)" if n == 6 else given.goal)


def same_goal(n, given, x):
    return dataclasses.replace(given, goal="(and (visited a) (visited b) (at b))" if n == 6 else given.goal)


def cancelled(n, given, x):
    return dataclasses.replace(given, goal="( and )" if n == 6 else given.goal)


def stopping(n, given, x):
    return dataclasses.replace(given, stopping=n == 6)


def ends(run):
    return [(f.tick, f.action_index, f.outcome, f.reason, f.detail) for f in messages(run, ActionFinished)]


@pytest.mark.parametrize(
    ("world", "reason", "detail"),
    [
        (disarmed, "disarmed", DISARM_DETAIL),
        (new_goal, "new goal", ""),
        (same_goal, "new goal", ""),
        (cancelled, "cancelled", ""),
        (stopping, "shutdown", ""),
    ],
)
def test_an_action_that_is_cut_off_is_reported_once_as_aborted(world, reason, detail):
    run = list(drive(line_context(), world=world, ticks=8))
    assert ends(run) == [(6, 0, "aborted", reason, detail)]
    (end,) = messages(run, ActionFinished)
    assert end.actual_s == pytest.approx(0.4), "it began in tick 2"


def test_nothing_is_reported_while_no_action_runs():
    def world(n, given, x):
        return new_goal(n, disarmed(n + 5, given, x), x)

    assert ends(list(drive(line_context(), world=world, ticks=3))) == []


def test_what_runs_after_a_disarm_has_a_number_of_its_own():
    run = list(drive(line_context(), world=disarmed, ticks=40))
    started = [(s.action_index, s.action) for s in messages(run, ExecStatus) if s.action]
    assert list(dict.fromkeys(started)) == [(0, "slide"), (1, "slide"), (2, "slide")]
    assert [outcome for _, _, outcome, _, _ in ends(run)] == ["aborted", "done", "done"]
