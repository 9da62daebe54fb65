"""Derived predicates abbreviate conditions on facts; recursive ones are refused."""

import pytest

from tailor.executive.planning import MATCHING, PddlError, Settings, Unsupported, parse_domain, parse_problem, validate
from tailor.executive.planning.pddl.substitution import substituted
from tests.support.planning.planning_problems import read, solve

BLOCKS = """
(define (domain blocks) (:requirements :strips :derived-predicates)
  (:predicates (on ?x ?y) (down ?x) (held ?x) (clear ?x) (free))
  (:derived (clear ?b) (and (not (held ?b)) (not (exists (?x) (on ?x ?b)))))
  (:derived (free) (forall (?x) (not (held ?x))))
  (:action lift :parameters (?x) :precondition (and (free) (clear ?x) (down ?x))
    :effect (and (held ?x) (not (down ?x))))
  (:action take :parameters (?x ?y) :precondition (and (free) (clear ?x) (on ?x ?y))
    :effect (and (held ?x) (not (on ?x ?y))))
  (:action drop :parameters (?x) :precondition (held ?x) :effect (and (down ?x) (not (held ?x))))
  (:action stack :parameters (?x ?y) :precondition (and (held ?x) (clear ?y))
    :effect (and (on ?x ?y) (not (held ?x)))))"""
SWAP = "(define (problem swap) (:domain blocks) (:objects a b) (:init (on a b) (down b)) (:goal (on b a)))"


@pytest.mark.parametrize("settings", [MATCHING, Settings(ground=False), Settings()], ids=["ground", "lifted", "auto"])
def test_blocks_are_swapped_although_no_action_names_what_is_clear(settings):
    domain, problem = read(BLOCKS, SWAP)
    plan = solve(domain, problem, settings).plan
    assert [" ".join(step.action) for step in plan.steps] == ["take a b", "drop a", "lift b", "stack b a"]
    assert validate(plan, domain, problem) == ""
    assert {link.literal.fact[0] for link in plan.links} <= {"on", "down", "held"}


# --- definitions ---------------------------------------------------------------------------------
TYPES = "(:types block table - thing) (:constants t - table)"


def formula(rules, condition, predicates="(p ?x ?y) (q ?x) (r ?x ?y) (s ?x)"):
    """What the readers make of a condition."""
    domain = f"(define (domain d) {TYPES} (:predicates {predicates}) {rules}"
    action = f"(:action a :parameters (?x ?y - block) :precondition {condition} :effect (q ?x))"
    return parse_domain(f"{domain} {action})").actions[0].conditions[0].formula


@pytest.mark.parametrize(
    ("rules", "condition", "meaning"),
    [
        ("(:derived (p ?a ?b) (r ?b ?a))", "(p ?x ?y)", "(r ?y ?x)"),
        ("(:derived (p ?y ?x) (r ?y ?x))", "(p ?y t)", "(r ?y t)"),
        ("(:derived (s ?a) (r ?a ?a))", "(not (s ?y))", "(not (r ?y ?y))"),
        ("(:derived (s ?a) (= ?a t)) (:derived (s ?b) (r ?b t))", "(s ?x)", "(or (= ?x t) (r ?x t))"),
        ("(:derived (s ?a) (not (p t ?a))) (:derived (p ?x ?y) (imply (q ?x) (r ?x ?y)))", "(s ?y)",
         "(not (imply (q t) (r t ?y)))"),
        ("(:derived (s ?a) (exists (?y) (r ?a ?y)))", "(s ?y)", "(exists (?y') (r ?y ?y'))"),
        ("(:derived (s ?a) (exists (?y) (forall (?y') (r ?y ?y'))))", "(s ?y)",
         "(exists (?y') (forall (?y'') (r ?y' ?y'')))"),
        ("(:derived (s ?a) (exists (?a) (q ?a)))", "(s ?y)", "(exists (?a) (q ?a))"),
        ("(:derived (s ?a - block) (q ?a))", "(s ?y)", "(exists (?a' - block) (and (= ?a' ?y) (q ?a')))"),
    ],
)  # fmt: skip
def test_a_definition_takes_the_place_of_a_derived_predicate(rules, condition, meaning):
    assert formula(rules, condition) == formula("", meaning)


def test_a_narrower_type_is_not_tested_where_the_predicate_has_it_already():
    declared = "(q ?x) (s ?x - block)"
    assert formula("(:derived (s ?a) (q ?a))", "(s ?y)", declared) == formula("", "(q ?y)", declared)


def test_a_rule_of_a_type_does_not_hold_for_objects_of_another():
    text = f"(define (domain d) {TYPES} (:predicates (ok ?x) (done)) (:derived (ok ?b - block) (= ?b ?b))"
    domain = parse_domain(f"{text} (:action a :parameters (?x - thing) :precondition (ok ?x) :effect (done)))")
    for objects, status in (("b - block", "solved"), ("u - table", "unsolvable")):
        problem = parse_problem(
            f"(define (problem p) (:domain d) (:objects {objects}) (:init) (:goal (done)))", domain
        )  # fmt: skip
        assert solve(domain, problem, MATCHING).status == status


@pytest.mark.parametrize(("objects", "status"), [("u - block", "unsolvable"), ("u - table", "solved")])
def test_a_predicate_of_a_type_does_not_hold_for_objects_of_another(objects, status):
    types = "(:types block table - thing)"
    text = f"(define (domain d) {types} (:predicates (ok ?x - block) (done)) (:derived (ok ?b) (= ?b ?b))"
    domain = parse_domain(f"{text} (:action a :parameters (?x - thing) :precondition (not (ok ?x)) :effect (done)))")
    problem = f"(define (problem p) (:domain d) (:objects {objects}) (:init) (:goal (done)))"
    assert solve(domain, parse_problem(problem, domain), MATCHING).status == status


def test_free_variables_without_a_term_stay():
    condition = formula("", "(exists (?z) (r ?x ?z))")
    assert substituted(condition, {}) == condition


def test_a_derived_predicate_may_be_called_either():
    condition = formula(
        "(:derived (either ?a) (exists (?b - (either block table)) (r ?a ?b)))",
        "(either ?x)",
        "(q ?x) (r ?x ?y) (either ?x)",
    )
    assert condition == formula("", "(exists (?b - (either block table)) (r ?x ?b))")


# --- refusals ------------------------------------------------------------------------------------
def refusal(parts, kind=PddlError):
    with pytest.raises(kind) as caught:
        parse_domain(f"(define (domain d)\n (:predicates (p) (q ?x) (r ?x ?y))\n {parts})", "my.pddl")
    return str(caught.value)


@pytest.mark.parametrize(
    ("rules", "place", "name"),
    [
        ("(:derived (r ?x ?y) (exists (?z) (and (r ?x ?z) (r ?z ?y))))", "3:2", "r"),
        ("(:derived (p) (q t)) (:derived (q ?x) (p))", "3:2", "p"),
        ("(:derived (p) (r t t)) (:derived (r ?x ?y) (not (q ?x))) (:derived (q ?x) (r ?x ?x))", "3:25", "r"),
    ],
)
def test_a_recursive_one_is_refused_by_name_with_its_place(rules, place, name):
    assert refusal(rules, Unsupported) == f"my.pddl:{place}: the recursive derived predicate '{name}' is not supported"


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ("(:derived (s) (p))", "3:12: unknown predicate 's'"),
        ("(:derived (p))", "3:2: expected (:derived (predicate ?parameter ...) condition)"),
        ("(:derived (q) (p))", "3:12: 'q' expects 1 parameter, found 0"),
        ("(:derived (p) (q ?x))", "3:19: unknown variable '?x'"),
        ("(:derived p (q ?x))", "3:12: expected (predicate ?parameter ...), found 'p'"),
        ("(:derived (p) q)", "3:16: expected a condition, found 'q'"),
        ("(:derived (p) (and)) (:action a :effect (p))",
         "3:42: 'p' is derived, so it can be neither a fact nor an effect"),
        ("(:derived (q ?x) (and" + " (p)" * 100 + "))", "3:2: the definition of 'q' has more than 100 parts"),
    ],
)  # fmt: skip
def test_errors_point_at_line_and_column(parts, message):
    assert refusal(parts).startswith(f"my.pddl:{message}")


@pytest.mark.parametrize("item", ["(clear a)", "(at 3 (free))"])
def test_a_derived_predicate_is_no_initial_fact(item):
    with pytest.raises(PddlError, match="is derived, so it can be neither a fact nor an effect"):
        read(BLOCKS, SWAP.replace("(:init", f"(:init {item}"))
