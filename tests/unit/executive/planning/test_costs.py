"""Costs that depend on parameters: bound with the step, defined and at least 0 in every plan."""

import dataclasses

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import (
    DEFAULT,
    AnytimeSearch,
    Settings,
    Unsupported,
    parse_plan,
    validate,
    validate_every_order,
)
from tests.support.planning.planning_problems import read, solve

DOMAIN = """(define (domain d) (:predicates (r) (s)) (:functions (total-cost) (f ?x) (g ?x))
  (:action act :parameters (?x) :effect (and (r) (increase (total-cost) {}))))"""
PROBLEM = """(define (problem x) (:domain d) (:objects a b c) (:init (= (total-cost) 0) {}) (:goal (r))
  (:metric minimize (total-cost)))"""
LIFTED = Settings(ground=False, engine="pocl", node_limit=500)
BOTH = [Settings(node_limit=500), LIFTED]


@pytest.fixture(params=BOTH, ids=["ground", "lifted"])
def options(request):
    """Each problem is planned with ground actions, and with variables."""
    return request.param


def best(domain, problem, settings):
    """An anytime search that has ended."""
    search = AnytimeSearch(domain, problem, settings)
    while not search.ended:
        search.advance(CheckBudget(100))
    return search


@pytest.mark.parametrize(
    ("cost", "values", "chosen", "least"),
    [
        ("(f ?x)", "(= (f a) 5) (= (f b) 1) (= (f c) 7)", "b", 1),
        ("(f ?x)", "(= (f c) 5)", "c", 5),
        ("(/ 6 (f ?x))", "(= (f a) 1) (= (f b) 0) (= (f c) 2)", "c", 3),
        ("(* (f ?x) (g ?x))", "(= (f a) 1) (= (f b) 2) (= (f c) 1) (= (g b) 3) (= (g c) 9)", "b", 6),
    ],
    ids=["all", "one", "no divisor", "a product"],
)
def test_the_cheapest_object_is_proven_to_be_the_best(cost, values, chosen, least, options):
    domain, problem = read(DOMAIN.format(cost), PROBLEM.format(values))
    search = best(domain, problem, options)
    assert [step.action for step in search.best.plan.steps] == [("act", chosen)]
    assert (search.value, search.ended) == (least, "proven")


def test_the_total_cost_is_no_constant_of_a_cost_or_duration():
    for domain in (
        DOMAIN.format("(+ 1 (total-cost))"),
        """(define (domain d) (:predicates (r) (s)) (:functions (total-cost) (f ?x))
        (:durative-action act :parameters () :duration (>= ?duration (total-cost)) :effect (at end (r))))""",
    ):
        with pytest.raises(Unsupported, match=r"the changing \(total-cost\) in a number is not supported"):
            read(domain, PROBLEM.format(""))


def test_the_second_search_drops_plans_that_cost_as_much(options):
    """A step may be repeated for ever: without its cost the search would not end."""
    domain, problem = read(
        """(define (domain d) (:predicates (at ?x) (road ?x ?y)) (:functions (total-cost) (length ?x ?y))
          (:action drive :parameters (?x ?y) :precondition (and (at ?x) (road ?x ?y))
            :effect (and (not (at ?x)) (at ?y) (increase (total-cost) (length ?x ?y)))))""",
        """(define (problem p) (:domain d) (:objects a b c)
          (:init (at a) (road a b) (road b a) (road b c) (road a c)
            (= (length a b) 1) (= (length b a) 1) (= (length b c) 2) (= (length a c) 9))
          (:goal (at c)) (:metric minimize (total-cost)))""",
    )
    search = best(domain, problem, options)
    assert (search.value, search.ended) == (3, "proven")


def test_an_action_without_a_value_of_its_cost_is_never_applicable(options):
    domain, problem = read(DOMAIN.format("(f ?x)"), PROBLEM.format(""))
    assert solve(domain, problem, options).status == "unsolvable"


@pytest.mark.parametrize("values", ["", "(= (f a) 0)", "(= (f a) -1)"], ids=["none", "no divisor", "negative"])
def test_a_given_plan_without_a_cost_is_unsound(values):
    domain, problem = read(DOMAIN.format("(/ 1 (f ?x))"), PROBLEM.format(values))
    plan = parse_plan("(act a)")
    fault = "step 1: (act a) has no cost of at least 0"
    assert validate(plan, domain, problem) == validate_every_order(plan, domain, problem) == fault
    defined = dataclasses.replace(problem, values={("f", "a"): 2.0})
    assert validate(plan, domain, defined) == validate_every_order(plan, domain, defined) == ""


def test_a_negative_cost_is_refused_by_name_and_proves_nothing(options):
    domain, problem = read(DOMAIN.format("(- (f ?x) 2)"), PROBLEM.format("(= (f a) 1.5)"))
    reason = "the cost -0.5 of (act a) is not supported: it is below 0"
    result = solve(domain, problem, options)
    assert (result.status, result.reason) == ("unsupported", reason)
    assert best(domain, problem, options).ended == reason


def test_a_negative_cost_that_no_float_holds_is_refused_by_name(options):
    domain, problem = read(DOMAIN.format(f"(- 0 (* {'1e9 ' * 40}))"), PROBLEM.format(""))
    result = solve(domain, problem, options)
    assert (result.status, result.reason) == (
        "unsupported",
        "the cost below -1e+09 of (act a) is not supported: it is below 0",
    )


def test_a_negative_number_as_a_cost_is_outside_the_language():
    with pytest.raises(Unsupported, match=r"^domain:2:\d+: a cost below 0 is not supported$"):
        read(DOMAIN.format("-1"), PROBLEM.format(""))


def test_lifted_search_ranks_by_the_cost_as_ground_search_does():
    domain, problem = read(DOMAIN.format("(f ?x)"), PROBLEM.format("(= (f a) 5) (= (f b) 1) (= (f c) 7)"))
    for settings in (DEFAULT, Settings(ground=False), Settings(ground=False, engine="pocl", action_cost="metric")):
        assert solve(domain, problem, settings).plan.steps[0].action == ("act", "b")
