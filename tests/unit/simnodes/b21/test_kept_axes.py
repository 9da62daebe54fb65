"""Axes that keep their set-point when the guard stops: from then on it is where they are."""

import math

import pytest

from tailor.simnodes.guard import TIMEOUT_NS, Guard, Limit, Mode

A = "a" * 32
LIMITS = (Limit(-1.0, 1.0), Limit(0.0, 0.12, kept=0.03))


def moving():
    guard = Guard(LIMITS, epoch=7)
    assert guard.arm(0, A) is None
    assert guard.command(0, A, 1, (0.4, 0.12)) is None
    return guard


def test_a_stopped_guard_holds_them_where_they_are_and_the_others_at_zero():
    guard = moving()
    guard.estop()
    guard.keep((0.7, 0.05))
    assert guard.output(0) == (0.0, 0.05)
    assert guard.mode is Mode.ESTOPPED


def test_an_armed_guard_takes_commands_only():
    guard = moving()
    guard.keep((0.7, 0.05))
    assert guard.output(TIMEOUT_NS) == (0.4, 0.12)


@pytest.mark.parametrize("beyond", [-0.001, 0.121, math.nan, math.inf])
def test_where_an_axis_cannot_be_is_ignored(beyond):
    guard = moving()
    guard.estop()
    guard.keep((0.0, beyond))
    assert guard.output(0) == (0.0, 0.12)


def test_armed_anew_it_holds_them_there_until_the_first_command():
    guard = moving()
    assert guard.output(TIMEOUT_NS + 1) == (0.0, 0.12)
    guard.keep((0.0, 0.05))
    assert guard.arm(TIMEOUT_NS + 2, A) is None
    assert guard.output(TIMEOUT_NS + 2) == (0.0, 0.05)
