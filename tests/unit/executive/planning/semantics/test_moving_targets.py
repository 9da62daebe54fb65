"""The validator's rule of no moving targets: no event changes what a simultaneous one reads, in any of its formulas."""

import pytest

from tailor.executive.planning import parse_plan, validate
from tests.support.planning.planning_problems import read

DOMAIN = """(define (domain d) (:requirements :adl :durative-actions) (:types big small none)
  (:constants a - big b - small) (:predicates (p ?o) (s ?o ?u) (q) (g))
  (:durative-action write :parameters (?x ?y) :duration (= ?duration 2) :effect (and (at start (p ?x))
    (at start (s ?x ?y)) (at end (q))))
  (:durative-action look :parameters (?x) :duration (= ?duration 2) :condition {} :effect (and {} (at end (g)))))"""
PROBLEM = "(define (problem x) (:domain d) (:init (p a) (p b) (s a a) (s a b) (s b b)) (:goal (g)))"
TRUE = "(at start (p b))"


@pytest.mark.parametrize(
    ("condition", "effect", "disturbed"),
    [
        ("(at start (p ?x))", "", True),
        (TRUE, "", False),
        ("(at start (not (not (p ?x))))", "", True),
        ("(at start (or (= a b) (p b) (p a)))", "", True),
        ("(at start (forall (?z) (p ?z)))", "", True),
        ("(at start (exists (?z - small) (p ?z)))", "", False),
        ("(at start (exists (?z) (s ?z ?z)))", "", False),
        ("(at start (exists (?z) (s ?x ?z)))", "", True),
        ("(at start (exists (?x - small) (s ?x ?x)))", "", False),
        ("(at start (forall (?z - none) (p ?x)))", "", False),
        ("(at start (exists (?z) (and (p ?z) (= ?z b))))", "", False),
        ("(at start (exists (?z) (and (= ?x ?z) (p ?z))))", "", True),
        (TRUE, "(forall (?z) (when (at start (and (p ?z) (= ?z b))) (at end (q))))", False),
        (TRUE, "(forall (?z - small) (when (at start (and (= ?z ?x) (p ?x))) (at end (q))))", False),
        ("(at start (exists (?y ?z) (and (= ?y ?z) (p ?z))))", "", True),
        ("(at start (forall (?z) (or (not (= ?z b)) (p ?z))))", "", False),
        ("(at start (forall (?z) (imply (= ?z ?x) (p ?z))))", "", True),
        ("(at start (or (= ?x a) (and (= ?x b) (p ?x))))", "", False),
        ("(at start (or (= ?x a) (p ?x)))", "", False),
        ("(at start (or (= ?x b) (p ?x)))", "", True),
        ("(at start (or (not (= ?x b)) (p ?x)))", "", False),
        ("(at start (or (p b) (and (not (= ?x a)) (p ?x))))", "", False),
        ("(at start (forall (?z) (or (= ?z b) (p ?z))))", "", True),
        ("(over all (p ?x))", "", False),
        ("(at end (p ?x))", "", False),
        (TRUE, "(when (at start (p ?x)) (at end (q)))", True),
        (TRUE, "(forall (?z) (when (at start (p ?z)) (at end (q))))", True),
        (TRUE, "(forall (?z - small) (when (at start (p ?z)) (at end (q))))", False),
        (TRUE, "(forall (?z - none) (when (at start (p ?x)) (at end (q))))", False),
    ],
)
def test_what_a_simultaneous_event_makes_true_again_is_a_moving_target(condition, effect, disturbed):
    domain, problem = read(DOMAIN.format(condition, effect), PROBLEM)
    fault = validate(parse_plan("1: (write a b) [2]\n1: (look a) [2]"), domain, problem)
    assert fault == ("step 1 disturbs step 2 at the same time" if disturbed else "")
    assert validate(parse_plan("1: (write a b) [2]\n1.01: (look a) [2]"), domain, problem) == ""


def test_a_timed_literal_is_an_event_as_well():
    domain, problem = read(DOMAIN.format("(at start (p ?x))", ""), PROBLEM.replace("(:init", "(:init (at 1 (p a))"))
    assert "the timed literal (p a) disturbs" in validate(parse_plan("1: (look a) [2]"), domain, problem)
    assert validate(parse_plan("1: (look b) [2]"), domain, problem) == ""
