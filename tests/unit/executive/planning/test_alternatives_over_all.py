"""Alternatives of a condition over all may take turns; the search keeps to one, and does not call that a proof."""

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import AnytimeSearch, FlawOrder, Settings, parse_plan, validate
from tests.support.planning.planning_problems import read, solve

DOMAIN = """(define (domain d) (:requirements :adl :durative-actions :timed-initial-literals)
  (:constants a b) (:predicates (p) (q) (h ?x) (fixed) (g) (n))
  (:durative-action long :parameters () :duration (= ?duration 10) :condition {} :effect (at end (g)))
  {})"""
PROBLEM = """(define (problem x) (:domain d)
  (:init (p) (h a) (fixed) (at 4 (q)) (at 4 (h b)) (at 6 (not (p))) (at 6 (not (h a))) (at 11 (not (q)))
    (at 11 (not (h b)))) (:goal {}))"""
SLOW = "(:durative-action slow :parameters () :duration (= ?duration 20) :effect (at end (g)))"
OR = "(over all (or (p) (q)))"
SETTINGS = {
    "ground": Settings(),
    "lifted": Settings(ground=False),
    "deepening": Settings(search="IDA", flaw_orders=(FlawOrder("UCPOP"),)),
}


@pytest.fixture(params=SETTINGS.values(), ids=SETTINGS)
def options(request):
    """Every plan space, and both algorithms."""
    return request.param


@pytest.mark.parametrize(
    "condition",
    [
        OR,
        "(over all (not (and (not (p)) (not (q)))))",
        "(over all (imply (not (p)) (q)))",
        "(over all (exists (?x) (h ?x)))",
        "(and (at start (p)) (over all (and (fixed) (or (and (p) (h a)) (and (q) (h b))))))",
    ],
)
def test_a_plan_in_which_alternatives_take_turns_is_no_dead_end(condition, options):
    domain, problem = read(DOMAIN.format(condition, ""), PROBLEM.format("(g)"))
    assert validate(parse_plan("0.01: (long) [10]"), domain, problem) == ""
    result = solve(domain, problem, options)
    assert result.status == "limit"
    assert "of a condition over all with alternatives it keeps to one" in result.reason


@pytest.mark.parametrize("condition", [
    "(over all (and (p) (h a)))",
    "(over all (forall (?x) (h ?x)))",
    "(and (at start (or (p) (q))) (at end (or (not (q)) (not (fixed)))) (over all (p)))",
    "(over all (and (or (fixed) (q)) (p)))",
])  # fmt: skip
def test_without_alternatives_over_all_a_dead_end_is_a_proof(condition, options):
    domain, problem = read(DOMAIN.format(condition, ""), PROBLEM.format("(g)"))
    assert solve(domain, problem, options).status == "unsolvable"


def test_what_not_even_the_relaxed_graph_reaches_is_proven_to_be_out_of_reach(options):
    domain, problem = read(DOMAIN.format(OR, ""), PROBLEM.format("(and (g) (n))"))
    assert solve(domain, problem, options).status == "unsolvable"


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_no_plan_is_proven_to_be_the_best_beside_such_a_condition(ground):
    domain, problem = read(DOMAIN.format(OR, SLOW), PROBLEM.format("(g)"))
    search = AnytimeSearch(domain, problem, Settings(ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert search.value == pytest.approx(20.01)
    assert "it keeps to one" in search.ended
