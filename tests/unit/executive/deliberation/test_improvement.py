"""While an action runs a better plan may be found for the rest of the task; it is adopted between actions only."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import planning
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import Settings
from tailor.executive.deliberation.plan_reuse import Preparation, better
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.replay import RecordedTick, replay
from tailor.schemas.messages import ActionFinished, PlanReport
from tests.replay.test_replay_core import FickleBudget
from tests.support.planning.planning_problems import own, read
from tests.support.toy_domain import driver, line_context, odometry

TICK = 100_000_000
PLACES = {"home": {"x": 0.0}, "a": {"x": 0.5}, "b": {"x": 1.0}, "c": {"x": 1.5}}
PROBLEM = """
(define (problem three-places) (:domain line) (:objects home a b c)
  (:init (at home) (place a) (place b) (place c)) (:goal (and (visited a) (visited b) (visited c) (at c))))
"""
GOAL = "(and (visited a) (visited b) (visited c) (at c))"
SEEN = 0.01  # a shift of the places that means: somebody else has been at b


def three_places(settings=None):
    """The line with three places; b counts as visited once the shift is SEEN."""
    context = line_context(settings, PLACES, PROBLEM)

    def anchor(belief, scenario, remembered):
        return remembered | {("visited", "b")} if belief.shift == SEEN else remembered

    context.domain.anchor = anchor
    return context


def drive(context, seen_from, ticks=120, budget=lambda: CheckBudget(500), goal=GOAL, shift=SEEN):
    """Drives the point on the line; from tick `seen_from` on the places are shifted: by SEEN, somebody was at b."""
    state, x, ticks_run, published, states = initial_state(context), 0.0, [], [], []
    for n in range(1, ticks + 1):
        samples = (odometry(n * TICK, x, n, shift if n >= seen_from else 0.0), driver(n * TICK))
        given, granted = Inputs(samples, goal if n == 1 else ""), budget()
        state, outputs = step(context, state, n * TICK, given, granted)
        x += 0.1 * state.command[0]
        ticks_run.append(RecordedTick(n, n * TICK, given, granted.granted))
        published.append((n, outputs))
        states.append(state)
    return states, published, ticks_run


def messages_of(published, kind):
    return [(n, output.message) for n, outputs in published for output in outputs if isinstance(output.message, kind)]


def steps(report):
    return [step.action for step in planning.parse_plan(report.plan).steps]


def test_a_shortcut_that_shows_while_an_action_runs_is_taken_when_it_has_ended():
    states, published, _ = drive(three_places(), seen_from=4)
    (first, improved), ended = messages_of(published, PlanReport)[:2], messages_of(published, ActionFinished)
    assert [action[2] for action in steps(first[1])] == ["a", "b", "c"]
    assert (improved[1].status, improved[1].way) == ("solved", "improved")
    assert improved[0] == ended[0][0], "in the tick in which the action ended, and no sooner"
    assert improved[1].generated > 0
    assert steps(improved[1]) == [("slide", "a", "c")]
    assert states[-1].task.result == "achieved"
    assert len(ended) == 2


def test_without_it_the_longer_way_is_gone():
    _, published, _ = drive(three_places(Settings(improve_plans=0)), seen_from=4)
    assert {report.way for _, report in messages_of(published, PlanReport)} == {"searched", "suffix"}
    assert len(messages_of(published, ActionFinished)) == 3


def test_a_plan_that_cannot_be_shortened_stays_the_suffix():
    _, published, _ = drive(three_places(), seen_from=999)
    assert {report.way for _, report in messages_of(published, PlanReport)} == {"searched", "suffix"}
    assert len(messages_of(published, ActionFinished)) == 3


def test_it_has_the_lowest_priority_and_ends_by_itself():
    _, _, ticks_run = drive(three_places(), seen_from=999, ticks=20)
    assert ticks_run[0].checks > 0, "the first decision"
    assert ticks_run[10].checks == ticks_run[19].checks == 0, "proven: no shorter plan; nothing goes on"


def test_it_is_bounded_by_the_plans_that_it_may_generate(monkeypatch):
    searches = []
    real = planning.Search

    def spied(*arguments):
        searches.append(arguments[2])
        return real(*arguments)

    monkeypatch.setattr(planning, "Search", spied)
    drive(three_places(Settings(improve_plans=77)), seen_from=4, ticks=8)
    bounded = [(s.node_limit, s.step_limit) for s in searches if s.node_limit == 77]
    assert bounded[0] == (77, 1), "shorter than the two steps that are left"


def test_a_starved_tick_has_nothing_left_for_it():
    _, published, _ = drive(three_places(), seen_from=4, ticks=300, budget=lambda: CheckBudget(0))
    assert messages_of(published, PlanReport) == []


QUICK = Settings(refinement=RefinementSettings(gain_k_std=0.0))  # refinement ends early and leaves checks for plans


@pytest.mark.parametrize("seed", range(8))
def test_runs_in_which_a_better_plan_is_found_are_replayed_bit_for_bit(seed):
    rng = np.random.default_rng(seed)
    _, published, ticks_run = drive(three_places(QUICK), seen_from=4 + seed % 3, budget=lambda: FickleBudget(rng))
    assert list(replay(three_places(QUICK), ticks_run)) == published


def test_some_of_those_runs_do_find_one():
    ways = set()
    for seed in range(8):
        rng = np.random.default_rng(seed)
        _, published, _ = drive(three_places(QUICK), seen_from=4 + seed % 3, budget=lambda rng=rng: FickleBudget(rng))
        ways |= {report.way for _, report in messages_of(published, PlanReport)}
    assert ways == {"searched", "suffix", "improved"}


def test_better_means_strictly_fewer_steps_or_strictly_sooner():
    def plan(*ends, durative=False):
        return planning.Plan(
            "p", (), tuple(planning.Step(i, ("a",), end, 0.0) for i, end in enumerate(ends, 1)), durative=durative
        )

    _, plain = own("kitchen-s1")
    assert better(plan(1, 2), plan(1, 2, 3), plain)
    assert not better(plan(1, 2), plan(1, 1), plain)
    _, timed = own("kitchen-durative-s1")
    assert better(plan(1, 2, 3, durative=True), plan(9, durative=True), timed)
    assert not better(plan(9, durative=True), plan(9, durative=True), timed)


COSTS = """(define (domain shop) (:predicates (s) (p) (q)) (:functions (total-cost))
  (:action enter :parameters () :effect (and (s) (increase (total-cost) 1)))
  (:action dear :parameters () :precondition (s) :effect (and (q) (increase (total-cost) 9)))
  (:action cheap :parameters () :precondition (s) :effect (and (p) (increase (total-cost) 2)))
  (:action go :parameters () :precondition (p) :effect (and (q) (increase (total-cost) 3))))"""
SHOPPING = "(define (problem x) (:domain shop) (:init) (:goal (q)) (:metric minimize (total-cost)))"


def test_a_plan_of_more_steps_and_less_cost_is_better():
    domain, problem = read(COSTS, SHOPPING)
    dear = planning.completed(planning.parse_plan("(enter)\n(dear)\n"), domain, problem)
    context = replace(line_context(), pddl_domain=domain, problem=problem)
    inside = frozenset([("s",)])
    preparation = Preparation(context, dear, dear.steps[0].id, frozenset(), inside, "", planning.GroundCache())
    preparation.advance(CheckBudget(1000))
    now = problem.with_initial(inside)
    found = completed_work(preparation.better_plan(now)).plan
    assert [step.action for step in found.steps] == [("cheap",), ("go",)]
    left = planning.suffix(dear, frozenset({dear.steps[0].id}), domain, now)
    assert better(found, left, now)
    assert not better(left, found, now)


def two_robots():
    """A preparation after the first step of a plan for two robots that takes 56 s, though 28 will do."""
    domain, problem = own("kitchen-durative-s3")
    plan = planning.Search(domain, problem, COVERAGE).advance(CheckBudget(10**6)).plan
    expected = planning.apply_action(domain, problem, frozenset(problem.initial), plan.steps[0].action)
    context = replace(line_context(Settings(improve_plans=1600)), pddl_domain=domain, problem=problem)
    ground = planning.GroundCache()
    preparation = Preparation(context, plan, plan.steps[0].id, frozenset(), expected, "", ground)
    return preparation, plan, problem.with_initial(sorted(expected))


COVERAGE = planning.Settings(("ADDR", "ADDR_WORK", "BUC", "LIFO"), engine="pocl")


@pytest.mark.parametrize("checks", [7, 10**6])
def test_plans_with_durations_become_better_as_long_as_the_budget_lasts(checks):
    preparation, plan, problem = two_robots()
    for _ in range(2000 // checks + 1):
        preparation.advance(CheckBudget(checks))
    found = completed_work(preparation.better_plan(problem))
    assert found.way == "improved"
    assert plan.makespan > 50
    assert found.plan.makespan < 29
    assert planning.validate(found.plan, problem.domain, problem) == ""
    assert better(found.plan, plan, problem)


def test_a_failed_action_leaves_no_better_plan_behind():
    places = {**PLACES, "b": {"x": 95.0}}
    context = replace(three_places(), scenario=replace(three_places().scenario, places=places))
    _, published, _ = drive(context, seen_from=4, ticks=30)
    after = [n for n, f in messages_of(published, ActionFinished) if f.outcome == "failed"]
    ways = {n: report.way for n, report in messages_of(published, PlanReport)}
    assert all(ways.get(n) != "improved" for n in after)
