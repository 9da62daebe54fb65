"""A robot that people carry away while it drives: its action ends, and it decides anew from where it is put down."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.reasons import Reason
from tailor.schemas.messages import ActionFinished, PlanReport
from tests.support.toy_domain import LineDomain, inputs, line_context

TICK = 100_000_000
CARRIED = 8  # tick in which the robot is found elsewhere
FAR_M = 0.3


class Noticing(LineDomain):
    """Takes a step of more than 10 cm in a tick for a relocation."""

    def update(self, belief, now_ns, samples, command):
        after = super().update(belief, now_ns, samples, command)
        if belief.seen and abs(after.x - belief.x) > 0.1:
            return dataclasses.replace(after, carried=belief.carried + 1)
        return after

    def relocations(self, belief):
        return belief.carried


def drive(context, ticks=80):
    state, x, log = initial_state(context), 0.0, []
    for n in range(1, ticks):
        x += FAR_M if n == CARRIED else 0.0
        given = inputs(n * TICK, x, "(visited b)" if n == 1 else "")
        state, outputs = step(context, state, n * TICK, given, CheckBudget(200))
        x += 0.1 * state.command[0]
        log.append((state, [output.message for output in outputs], x))
    return log


@pytest.mark.promise("P6")
def test_its_action_fails_with_a_reason_and_it_decides_from_its_new_place():
    log = drive(dataclasses.replace(line_context(), domain=Noticing()))
    before, (found, messages, at) = log[CARRIED - 2][0], log[CARRIED - 1]
    assert before.task.running.parameters[0] == pytest.approx(0.0)
    (finished,) = [message for message in messages if isinstance(message, ActionFinished)]
    assert (finished.outcome, finished.reason, finished.action_index) == ("failed", Reason.ROBOT_CARRIED, 0)
    assert found.command == (0.0,)
    assert [message.way for message in messages if isinstance(message, PlanReport)] == ["searched"]
    begun = log[CARRIED][0].task.running
    assert begun.parameters[0] == pytest.approx(at)
    assert (log[-1][0].task.result, log[-1][0].task.finished) == ("achieved", 2)


def test_a_domain_that_does_not_notice_goes_on():
    log = drive(line_context())
    assert [m.outcome for _, messages, _ in log for m in messages if isinstance(m, ActionFinished)] == ["done"]
