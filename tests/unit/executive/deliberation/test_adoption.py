"""Adoption of a better subgoal by the action that runs, from the same deliberation."""

from dataclasses import replace

import pytest

from tailor.executive.core.adoption import adopted
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tests.support.toy_domain import inputs, line_context

TICK = 100_000_000
GAIN_S = 0.05


@pytest.fixture
def context():
    return line_context(Settings(adopt_gain_s=GAIN_S, refine_while_running_s=1.0))


def moving(context, ticks=4):
    state = initial_state(context)
    for n in range(1, ticks + 1):
        state, _ = step(
            context, state, n * TICK, inputs(n * TICK, 0.0, "(visited a)" if n == 1 else ""), CheckBudget(200)
        )
    assert state.task.running is not None
    return state


def offered(context, state, gain_s, decided=True):
    """The state after a decision of the same deliberation that is predicted to save so much."""
    decision = state.task.decision
    better = replace(decision, choice=replace(decision.choice, total_s=decision.choice.total_s - gain_s))
    return adopted(context, state, better, decided), better


@pytest.mark.parametrize("decided", [False, True])
def test_a_gain_above_the_threshold_is_adopted_before_and_after_the_search_ends(context, decided):
    state, better = offered(context, moving(context), GAIN_S + 0.01, decided)
    assert state.task.decision is better
    assert state.task.finished == 0, "the action goes on"


def test_a_gain_below_the_threshold_is_not(context):
    before = moving(context)
    assert offered(context, before, GAIN_S - 0.01)[0] is before


def test_after_a_second_no_gain_is(context):
    before = moving(context, ticks=13)
    assert offered(context, before, 10.0)[0] is before


def test_without_a_threshold_a_subgoal_that_is_no_better_is_not_adopted(context):
    context = replace(context, settings=Settings(adopt_gain_s=0.0))
    before = moving(context)
    assert offered(context, before, 0.0)[0] is before
    assert offered(context, before, 1e-6)[0] is not before
