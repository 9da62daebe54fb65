"""First any plan, then better ones: by makespan, by cost, by steps; the search can be cut into slices."""

from dataclasses import replace

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import (
    DEFAULT,
    MATCHING,
    AnytimeSearch,
    Settings,
    Unsupported,
    format_problem,
    parse_domain,
    parse_problem,
    quality,
    validate,
)
from tailor.executive.planning.settings import DEFAULT_RANKINGS
from tests.support.planning.planning_problems import own, read, solve

ROADS = """(define (domain roads) (:requirements :strips :action-costs)
  (:predicates (at ?x) (road ?x ?y)) (:functions (total-cost) - number (length ?x ?y) - number)
  (:action drive :parameters (?x ?y) :precondition (and (at ?x) (road ?x ?y))
    :effect (and (not (at ?x)) (increase (total-cost) (length ?x ?y)) (at ?y)))
  (:action fly :parameters (?x ?y) :precondition (at ?x)
    :effect (and (not (at ?x)) (at ?y) (increase (total-cost) 100))))"""
TRIP = """(define (problem p) (:domain roads) (:objects a b c d)
  (:init (at a) (road a b) (road b c) (road c d) (road a d) (= (total-cost) 0)
    (= (length a b) 1.5) (= (length b c) 2) (= (length c d) 0.25) (= (length a d) 20))
  (:goal (at d)) (:metric minimize (total-cost)))"""
DRIVES = [("drive", "a", "b"), ("drive", "b", "c"), ("drive", "c", "d")]


def improvements(domain, problem, settings, checks=10**9):
    """All results of an anytime search, advanced in slices of so many checks."""
    search, results = AnytimeSearch(domain, problem, settings), []
    while not search.ended:
        result = search.advance(CheckBudget(checks))
        results += [result] if result is not None else []
    return search, results


def test_the_makespan_falls_to_the_best_one():
    domain, problem = own("kitchen-durative-s3")
    search, results = improvements(domain, problem, DEFAULT)
    assert [result.plan.makespan for result in results] == [56.08, 28.04]
    assert search.ended == "proven"
    assert search.best == results[-1]
    assert all(validate(result.plan, domain, problem) == "" for result in results)


@pytest.mark.parametrize("checks", [1, 7, 100])
def test_slices_change_nothing(checks):
    settings = Settings(node_limit=400)
    whole = improvements(*own("kitchen-durative-s3"), settings)
    sliced = improvements(*own("kitchen-durative-s3"), settings, checks)
    assert sliced[1] == whole[1]
    assert sliced[0].counts == whole[0].counts


DELIVERY = """(define (domain delivery) (:requirements :durative-actions :timed-initial-literals)
  (:predicates (here) (packed) (open))
  (:durative-action by-bicycle :parameters () :duration (= ?duration 5) :condition () :effect (at end (here)))
  (:durative-action pack :parameters () :duration (= ?duration 1) :condition () :effect (at end (packed)))
  (:durative-action by-car :parameters () :duration (= ?duration 1) :condition (at start (packed))
    :effect (at end (here))))"""


@pytest.mark.parametrize("goal", ["(here)", "(and (here) (open))"])
@pytest.mark.parametrize("ground", [True, False])
def test_what_happens_later_by_itself_does_not_end_the_search_for_shorter_plans(goal, ground):
    initial = "(at 100 (open))"
    texts = (DELIVERY, f"(define (problem p) (:domain delivery) (:init {initial}) (:goal {goal}))")
    search, results = improvements(*read(*texts), Settings(ground=ground))
    assert [result.plan.makespan for result in results] == [5.01, 2.02]
    assert search.ended == "proven"


def test_the_first_plan_is_the_one_of_the_sure_rankings():
    domain, problem = own("kitchen-durative-s3")
    fastest = replace(problem, metric="makespan")
    _, results = improvements(domain, fastest, Settings(flaw_orders=MATCHING.flaw_orders, node_limit=1000))
    assert (results[0].generated, results[0].plan.makespan) == (solve(domain, problem).generated, 56.08)
    assert results[-1].plan.makespan == 28.04


def test_steps_fall_where_there_is_no_metric():
    domain, problem = own("soccer-typed-p3")
    search, results = improvements(domain, problem, Settings(engine="forward", node_limit=2000))
    values = [len(result.plan.steps) for result in results]
    assert values == sorted(set(values), reverse=True)
    assert search.value == values[-1] <= 12


@pytest.mark.parametrize(
    "settings", [DEFAULT, Settings(ground=False, node_limit=500), Settings(action_cost="metric", engine="pocl")]
)
def test_costs_are_minimised(settings):
    domain, problem = read(ROADS, TRIP)
    search, _ = improvements(domain, problem, settings)
    assert [step.action for step in search.best.plan.steps] == DRIVES
    assert search.value == 3.75
    assert quality(search.best.plan, problem) == 3.75
    assert search.ended == "proven"


ONE_OR_TWO = """(define (domain d) (:predicates (g) (h)) (:functions (total-cost))
  (:action one :effect (and (g) (increase (total-cost) {})))
  (:action first :effect (and (h) (increase (total-cost) {})))
  (:action second :precondition (h) :effect (and (g) (increase (total-cost) {}))))"""


@pytest.mark.parametrize("costs", [("9e-10", "1e-10", "1e-10"), ("1e9", "999999999", "0.9999"), ("0.3", "0.1", "0.1")])
def test_small_differences_of_costs_count(costs):
    problem = "(define (problem x) (:domain d) (:init) (:goal (g)) (:metric minimize (total-cost)))"
    domain, problem = read(ONE_OR_TWO.format(*costs), problem)
    search, _ = improvements(domain, problem, DEFAULT)
    assert [step.action for step in search.best.plan.steps] == [("first",), ("second",)]
    assert search.ended == "proven"


@pytest.mark.parametrize("ground", [True, False])
def test_a_makespan_that_is_a_nanosecond_shorter_is_better(ground):
    def action(name, duration, effect, condition=""):
        return (
            f"(:durative-action {name} :parameters () :duration (= ?duration {duration})"
            f" :condition (at start (and {condition})) :effect (at end {effect}))"
        )

    actions = [
        action("one", "100.000000002", "(g)"),
        action("first", "50", "(h)"),
        action("second", "49.990000001", "(g)", "(h)"),
    ]
    domain, problem = read(
        f"(define (domain d) (:predicates (g) (h)) {' '.join(actions)})",
        "(define (problem x) (:domain d) (:init) (:goal (g)))",
    )
    search, _ = improvements(domain, problem, Settings(ground=ground))
    assert (len(search.best.plan.steps), search.ended) == (2, "proven")


def test_a_search_without_more_ranks_by_the_cost_first():
    domain, problem = read(ROADS, TRIP)
    assert [step.action for step in solve(domain, problem, DEFAULT).plan.steps] == DRIVES
    without = read(ROADS, TRIP.replace("(:metric minimize (total-cost))", ""))
    assert len(solve(*without, DEFAULT).plan.steps) == 1


def test_problems_with_costs_are_written_as_they_were():
    domain, problem = read(ROADS, TRIP)
    assert parse_problem(format_problem(problem), domain) == problem


@pytest.mark.parametrize(
    ("effect", "reason"),
    [
        ("(and (at ?y) (when (at ?x) (increase (total-cost) 1)))", "a numeric effect"),
        ("(and (at ?y) (decrease (total-cost) 1))", "a numeric effect"),
        ("(and (at ?y) (increase (fuel) 1))", "a numeric effect"),
    ],
)
def test_other_numeric_effects_stay_refused_by_name(effect, reason):
    text = f"""(define (domain d) (:predicates (at ?x)) (:functions (total-cost) (fuel))
      (:action go :parameters (?x ?y) :precondition (at ?x) :effect {effect}))"""
    with pytest.raises(Unsupported, match=reason) as refused:
        parse_domain(text, "d.pddl")
    assert str(refused.value).startswith("d.pddl:2:")


def test_an_unsolvable_problem_ends_at_once():
    domain, problem = own("soccer-typed-p1")
    search, results = improvements(domain, problem.with_goal("(and (robot-at r1 p1) (not (robot-at r1 p1)))"), DEFAULT)
    assert [result.status for result in results] == ["unsolvable"]
    assert search.best.plan is None


# --- coverage ------------------------------------------------------------------------------------
def test_the_makespan_ranking_alone_no_longer_decides_what_is_found(monkeypatch):
    domain, problem = own("kitchen-durative-s3")
    hard = replace(problem, metric="makespan")
    monkeypatch.setattr("tailor.executive.planning.search.HEAD_START", 3)  # as if the metric's ranking took long
    result = solve(domain, hard, Settings(flaw_orders=MATCHING.flaw_orders))
    assert result.status == "solved"
    assert result.generated <= 3 * solve(domain, problem).generated


def test_a_condition_with_too_many_instances_ends_the_second_search_at_a_limit():
    makers = " ".join(f"(:action m{n} :parameters () :effect (h{n}))" for n in range(3))
    domain, problem = read(
        f"""(define (domain d) (:predicates (g) (h0) (h1) (h2) (q ?x ?y)) (:functions (total-cost)) {makers}
          (:action fill :parameters (?x ?y) :precondition (h0) :effect (q ?x ?y))
          (:action free :parameters (?x ?y) :precondition (and (h0) (h1) (h2) (not (q ?x ?y))) :effect (g))
          (:action paid :parameters () :effect (and (g) (increase (total-cost) 5))))""",
        f"""(define (problem x) (:domain d) (:objects {" ".join(f"o{n}" for n in range(51))}) (:init) (:goal (g))
          (:metric minimize (total-cost)))""",
    )
    search, results = improvements(domain, problem, Settings(ground=False))
    assert [step.action for step in search.best.plan.steps] == [("paid",)]
    assert search.ended == "'not q' has more than 2500 instances"
    assert len(results) == 1


# --- what exclusive facts leave ------------------------------------------------------------------
VISITS = """(define (domain visits) (:requirements :durative-actions)
  (:predicates (at ?r ?x) (seen ?x) (off ?r) (on ?r) (ready ?r))
  (:durative-action start :parameters (?r) :duration (= ?duration 2) :condition (at start (off ?r))
    :effect (and (at start (not (off ?r))) (at end (on ?r))))
  (:durative-action adjust :parameters (?r) :duration (= ?duration 3) :condition (over all (on ?r))
    :effect (at end (ready ?r)))
  (:durative-action go :parameters (?r ?x ?y) :duration (= ?duration 5) :condition (at start (at ?r ?x))
    :effect (and (at start (not (at ?r ?x))) (at end (at ?r ?y))))
  (:durative-action look :parameters (?r ?x) :duration (= ?duration 7)
    :condition (and (over all (ready ?r)) (over all (at ?r ?x))) :effect (at end (seen ?x))))"""
SIX = """(define (problem p) (:domain visits) (:objects a b h p1 p2 p3 p4 p5 p6)
  (:init (off a) (off b) (at a h) (at b h))
  (:goal (and (seen p1) (seen p2) (seen p3) (seen p4) (seen p5) (seen p6))))"""


def test_work_is_divided_among_robots_although_one_could_do_all_with_fewer_steps():
    domain, problem = read(VISITS, SIX)
    search, results = improvements(domain, problem, Settings(engine="pocl", node_limit=6000))
    assert results[0].plan.makespan > 70
    assert search.value == pytest.approx(3 * (5 + 7), abs=0.1)
    assert all(validate(result.plan, domain, problem) == "" for result in results)


def test_both_searches_together_keep_to_the_limit_of_generated_plans():
    domain, problem = read(VISITS, SIX)
    first = solve(domain, problem, Settings(rankings=DEFAULT_RANKINGS))
    search, _ = improvements(domain, problem, Settings(engine="pocl", node_limit=2000))
    most = 100  # children of one plan
    assert search.ended == "1000 plans generated"
    assert 2000 <= search.counts[0] - first.generated < 2000 + 2 * most


@pytest.mark.parametrize("checks", [1, 7])
def test_slices_change_nothing_of_searches_by_turns(checks):
    settings = Settings(engine="pocl", node_limit=3000)
    whole, sliced = improvements(*read(VISITS, SIX), settings), improvements(*read(VISITS, SIX), settings, checks)
    assert sliced[1] == whole[1]
    assert sliced[0].counts == whole[0].counts


def test_chosen_rankings_are_kept():
    domain, problem = read(VISITS, SIX)
    search, _ = improvements(domain, problem, Settings(rankings=("ADDR", "LIFO"), engine="pocl", node_limit=500))
    assert search.ended == "500 plans generated"
