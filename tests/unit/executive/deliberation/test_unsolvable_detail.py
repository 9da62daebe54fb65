"""The detail of a task that is unsolvable: from which state, of what actions can change."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import planning
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.planning.semantics import action_effects
from tests.support.toy_domain import PROBLEM, line_context
from tests.unit.executive.core.test_core import drive

NOT_EVEN = "the goal cannot be reached, not even without delete effects"
UNKNOWN = "(and (visited a) (place home))"  # nothing makes a place


def cause_of(context, goal=UNKNOWN):
    *_, (state, _, _) = drive(context, goal=goal, ticks=10)
    return state.task.result_cause


def test_it_names_the_believed_state_without_what_no_action_changes():
    assert cause_of(line_context()) == Cause(Reason.UNSOLVABLE, f"{NOT_EVEN}, from (at home)")


def test_of_many_facts_it_names_twelve():
    names = [f"p{k:02d}" for k in range(20)]
    places = {name: {"x": 0.1} for name in ("home", "a", "b", *names)}
    problem = PROBLEM.replace("home a b)", f"home a b {' '.join(names)})")
    problem = problem.replace("(at home)", "(at home) " + " ".join(f"(visited {name})" for name in names))
    cause = cause_of(line_context(places=places, problem=problem))
    listed = " ".join(f"(visited {name})" for name in names[:11])
    assert cause == Cause(Reason.UNSOLVABLE, f"{NOT_EVEN}, from (at home) {listed} ...")


def test_a_search_that_came_to_its_limit_proves_nothing_of_the_state():
    planner = replace(planning.DEFAULT, node_limit=1)
    cause = cause_of(line_context(Settings(planner=planner)), goal="(and (visited a) (visited b))")
    assert cause is not None
    assert cause.reason is Reason.SEARCH_LIMIT
    assert " from " not in cause.detail


def test_a_plan_whose_effects_do_not_fit_into_a_tick_is_refused_by_its_step(monkeypatch):
    assert cause_of(line_context(), goal="(visited a)") is None
    monkeypatch.setattr(action_effects, "MAX_APPLIED", 2)
    limit = "step 1: the effects of (slide home a) have 3 instances, too many for a tick"
    assert cause_of(line_context(), goal="(visited a)") == Cause(Reason.SEARCH_LIMIT, limit)


@pytest.mark.parametrize(("facts", "ends"), [(12, "(visited p10)"), (13, "...")])
def test_only_what_is_left_out_is_marked(facts, ends):
    names = [f"p{k:02d}" for k in range(facts - 1)]
    places = {name: {"x": 0.1} for name in ("home", "a", "b", *names)}
    problem = PROBLEM.replace("home a b)", f"home a b {' '.join(names)})")
    problem = problem.replace("(at home)", "(at home) " + " ".join(f"(visited {name})" for name in names))
    assert cause_of(line_context(places=places, problem=problem)).detail.endswith(ends)
