"""A quantified effect may reuse the name of a variable around it; conditions outside keep reading the outer one."""

import pytest

from tailor.executive.planning import Settings, validate
from tailor.executive.planning.ground import grounding
from tests.support.planning.planning_problems import read, solve

DOMAIN = """(define (domain d) (:requirements :adl) (:types big small)
  (:predicates (p ?o) (q ?o) (sel ?o) (s ?o ?u))
  (:action act :parameters (?x ?x') :precondition (and (sel ?x) (= ?x ?x')) :effect {}))"""
PROBLEM = "(define (problem x) (:domain d) (:objects a - big b - small) (:init {}) (:goal {}))"
INNER = "(when (p ?x) (forall (?x) (q ?x)))"
BOTH = "(and (q a) (q b))"


@pytest.fixture(params=["ground", "reachable", "lifted"])
def options(request, monkeypatch):
    """Each way of reading effects: tried for all objects, by reachability, and with variables."""
    if request.param == "reachable":
        monkeypatch.setattr(grounding, "MAX_BINDINGS", 0)
    return Settings(ground=request.param != "lifted", node_limit=200)


@pytest.mark.parametrize(
    ("effect", "initial", "goal", "plan"),
    [
        (INNER, "(sel a) (p b)", "(q b)", None),
        (INNER, "(sel a) (p a)", BOTH, [("act", "a", "a")]),
        (f"(forall (?x) {INNER})", "(sel a) (p b)", BOTH, [("act", "a", "a")]),
        (f"(forall (?x - big) {INNER})", "(sel b) (p b)", BOTH, None),
        ("(when (p ?x) (forall (?x) (when (exists (?x') (s ?x ?x')) (q ?x))))", "(sel a) (p a) (s b a)", "(q b)",
         [("act", "a", "a")]),
        ("(when (p ?x) (forall (?x) (when (exists (?x') (s ?x ?x')) (q ?x))))", "(sel a) (p a) (s a b)", "(q b)",
         None),
        ("(when (p ?x) (forall (?x - small ?x') (s ?x ?x')))", "(sel a) (p a)", "(and (s b a) (s b b))",
         [("act", "a", "a")]),
        ("(when (p ?x) (forall (?x - small ?x') (s ?x ?x')))", "(sel a) (p a)", "(s a b)", None),
    ],
)  # fmt: skip
def test_conditions_around_an_effect_read_the_outer_variable(effect, initial, goal, plan, options):
    domain, problem = read(DOMAIN.format(effect), PROBLEM.format(initial, goal))
    result = solve(domain, problem, options)
    if plan is None:
        assert result.status == "unsolvable"
    else:
        assert [step.action for step in result.plan.steps] == plan
        assert validate(result.plan, domain, problem) == ""


def test_timed_conditions_around_an_effect_read_the_outer_variable(options):
    domain, problem = read(
        """(define (domain d) (:predicates (p ?o) (q ?o)) (:durative-action act :parameters (?x)
          :duration (= ?duration 1) :effect (when (at start (p ?x)) (forall (?x) (at end (q ?x))))))""",
        "(define (problem x) (:domain d) (:objects a b) (:init (p b)) (:goal (and (q a) (q b))))",
    )
    result = solve(domain, problem, options)
    assert [step.action for step in result.plan.steps] == [("act", "b")]
    assert validate(result.plan, domain, problem) == ""
