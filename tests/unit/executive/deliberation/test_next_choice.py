"""Where decisions take several ticks, the choice after the running action is searched while it runs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.core.state import undecided
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.action import Parameter
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Interval
from tailor.executive.refinement.objective.settings import RefinementSettings
from tests.support.toy_domain import SLIDE, LineDomain, line_context
from tests.unit.executive.deliberation.test_improvement import PROBLEM, TICK, drive

PLACES = {"home": {"x": 0.0}, "a": {"x": 3.0}, "b": {"x": 6.0}, "c": {"x": 9.0}}
SLOW_MPS = 0.3  # an action that starts faster loses much time: alone, each action would end as fast as it can
ONE, FEW, MANY = 1, 3, 500
MOVED_M = 0.5  # more than the tolerance of a slide


class HastePunished:
    """Distance over speed, and 40 s for each m/s above SLOW_MPS at the start."""

    card = {"sha256": "toy"}

    def predict(self, arguments):
        x, xg, v, start_v = arguments.T
        return np.abs(xg - x) / v + 40 * np.maximum(start_v - SLOW_MPS, 0.0), np.full(len(arguments), 0.01)


class HastyDomain(LineDomain):
    actions = {"slide": replace(SLIDE, parameters=(*SLIDE.parameters, Parameter("v0", 0, "v", "m/s", 0.0, 0.5)))}

    def value(self, query):
        if query.quantity == "v" and ("at", query.label) in query.holds:
            return Interval(0.0, 0.0)
        return super().value(query)


@pytest.fixture
def context():
    settings = Settings(refinement=RefinementSettings(arrival_spread=()), improve_plans=0)
    made = line_context(settings, PLACES, PROBLEM)
    return replace(made, domain=HastyDomain(), models=Models({"slide/duration": HastePunished()}, {}))


def driven(context, checks, ticks=120, moved_at=999):
    """The states of the drive, until the third action has begun; from tick `moved_at` on the places lie elsewhere."""
    states, _, _ = drive(context, moved_at, ticks, lambda: CheckBudget(checks), shift=MOVED_M)
    return states


def speeds(state):
    """The speeds chosen for the subgoals ahead, by place."""
    decision = state.task.decision
    variables = decision.sequence.variables
    return {variables[i].label: value for i, value in decision.choice.values.items() if variables[i].quantity == "v"}


def first_of_second_action(states):
    return next(state for state in states if state.task.decision is not None and state.task.finished == 1)


def test_the_next_decision_begins_with_the_choice_that_was_searched_while_the_action_ran(context):
    states = driven(context, FEW)
    first = first_of_second_action(states)
    ended_ns = next(state.now_ns for state in states if state.task.finished == 1)
    assert first.now_ns - ended_ns <= TICK, "its search has only begun"
    assert speeds(first)["b"] == pytest.approx(SLOW_MPS, abs=0.02)


def test_without_it_the_action_begins_with_the_greedy_choice(context, monkeypatch):
    monkeypatch.setattr("tailor.executive.deliberation.next_choice.NextChoice.values", lambda self: {})
    assert speeds(first_of_second_action(driven(context, FEW)))["b"] > SLOW_MPS + 0.1


def test_nothing_is_searched_where_a_decision_takes_one_tick(context):
    assert all(state.next_choice is None for state in driven(context, MANY))


def test_what_was_searched_for_another_plan_or_place_is_not_used(context):
    states = driven(context, FEW)
    with_choice = next(state for state in states if state.next_choice is not None and state.next_choice.values())
    assert with_choice.next_choice.decision.plan is with_choice.task.plan
    assert undecided(with_choice).next_choice is None


def test_a_search_whose_result_would_come_too_late_makes_way_for_it(context):
    states = driven(context, ONE, ticks=60)
    begun_ns = next(state.now_ns for state in states if state.task.running is not None)
    prepared = next(state for state in states if state.next_choice is not None)
    assert (prepared.now_ns - begun_ns) / 1e9 == pytest.approx(context.settings.refine_while_running_s + 0.1)
    assert not prepared.deliberation.refinement.finished


@pytest.mark.parametrize("checks", [ONE, FEW, MANY])
def test_what_moves_while_the_search_goes_on_is_decided_anew_at_once(context, checks):
    states = driven(context, checks, ticks=12, moved_at=10)
    assert [state.deliberations for state in states[8:10]] == [1, 2]


def test_two_equal_runs_choose_equally(context):
    assert [speeds(s) for s in driven(context, FEW) if s.task.decision] == [
        speeds(s) for s in driven(context, FEW) if s.task.decision
    ]
