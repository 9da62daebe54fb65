"""A place turns out to be elsewhere while the robot drives there: what was chosen out of its range is chosen anew."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.values import Interval
from tests.support.toy_domain import SLIDE, LineDomain, inputs, line_context

MS = 1_000_000
WIDTH_M = 1.0


class WidePlaces(LineDomain):
    """The toy robot, whose places are anywhere within a range of x."""

    actions = {"slide": replace(SLIDE, parameters=tuple(replace(p, tolerance=None) for p in SLIDE.parameters))}

    def value(self, query):
        exact = super().value(query)
        if exact is None or ("at", query.label) in query.holds:
            return exact
        return Interval(exact.lower, exact.lower + WIDTH_M)


def run(shift, ticks=20):
    """State after ticks of which the sixth is the first in which the places have moved by `shift`."""
    context = replace(
        line_context(Settings(), {"home": {"x": 0.0}, "a": {"x": 3.0}, "b": {"x": 6.0}}), domain=WidePlaces()
    )
    state, x = initial_state(context), 0.0
    for tick in range(1, ticks + 1):
        received = inputs(tick * 100 * MS, x, context.problem.goal_text if tick == 1 else "")
        odom = replace(received.samples[0].message, y=shift if tick > 5 else 0.0)
        samples = (replace(received.samples[0], message=odom), *received.samples[1:])
        state, _ = step(context, state, tick * 100 * MS, replace(received, samples=samples), CheckBudget(2000))
        x += 0.1 * state.command[0]
    return state


@pytest.mark.parametrize("shift", [0.12, 0.5, 1.0])
def test_choice_that_is_left_by_its_range_is_decided_anew_while_the_action_runs(shift):
    state = run(shift)
    assert (state.deliberations, state.task.finished) == (2, 0)
    goal = state.task.running.parameters[1]
    assert 3.0 + shift - 1e-9 <= goal <= 4.0 + shift


@pytest.mark.parametrize("shift", [0.0, 0.08, -0.5])
def test_choice_within_its_moved_range_is_kept(shift):
    assert run(shift).deliberations == 1
