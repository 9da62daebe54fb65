"""Formulas over many objects are evaluated in portions, with the result of the evaluation in one go."""

import random

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import (
    PacedWork,
    completion,
    format_plan,
    parse_plan,
    shortest_suffix,
    too_large_to_execute,
    validation,
)
from tailor.executive.planning.pddl.formula_reader import Scope, read_formula
from tailor.executive.planning.pddl.syntax.s_expressions import read_form
from tailor.executive.planning.plans.portions import FREE_PORTIONS, PORTIONS, completed_work
from tailor.executive.planning.semantics import completion as completion_module
from tailor.executive.planning.semantics import large_formulas, state
from tailor.executive.planning.semantics import suffix as suffix_module
from tailor.executive.planning.semantics.state import PORTION_PARTS, Objects, TooLargeError, holds, support
from tests.support.planning.planning_problems import own, read, solve

WORLD = read(
    "(define (domain d) (:types t u) (:predicates (p ?x) (q ?x ?y)))",
    "(define (problem x) (:domain d) (:objects a b - t c - u) (:init (p a) (q a b) (q b c)) (:goal ()))",
)
ATOMS = ("(p ?x)", "(p a)", "(q ?x ?y)", "(q ?y b)", "(= ?x ?y)")


def random_formula(rng, depth):
    if not depth:
        return rng.choice(ATOMS)
    parts = [random_formula(rng, depth - 1) for _ in range(rng.randint(1, 3))]
    return rng.choice(
        [
            f"(and {' '.join(parts)})",
            f"(or {' '.join(parts)})",
            f"(not {parts[0]})",
            f"(forall (?x - {rng.choice('tu')}) {parts[0]})",
            f"(exists (?y ?x - {rng.choice(['object', 't'])}) {parts[0]})",
        ]
    )


@pytest.mark.parametrize("size", [2, 4, 8])
def test_portions_have_the_result_of_the_whole(monkeypatch, size):
    monkeypatch.setattr(large_formulas, "PORTION_PARTS", size)
    domain, problem = WORLD
    objects, scope = Objects(problem), Scope.of(domain, problem.objects)
    rng, binding, seen = random.Random(4), {"?x": "a", "?y": "c"}, {True: 0, False: 0}
    inner = Scope(domain, {**scope.terms, "?x": ("object",), "?y": ("object",)})
    for _ in range(300):
        formula = read_formula(read_form(random_formula(rng, 3), "f"), inner)
        true = holds(formula, binding, objects.initial, objects)
        seen[true] += 1
        assert completed_work(large_formulas.holding(formula, binding, objects.initial, objects)) == true
        if true:
            literals = completed_work(large_formulas.supporting(formula, binding, objects.initial, objects))
            assert literals == support(formula, binding, objects.initial, objects)
    assert min(seen.values()) > 50


# --- in an executive's tick --------------------------------------------------------------------------
class MeteredBudget(CheckBudget):
    """Notes how many bindings of quantifiers were made before each check."""

    def __init__(self, monkeypatch):
        super().__init__(10**9)
        self.made, self.before_check = 0, []
        real = Objects.bindings

        def counted(objects, variables, binding):
            for inner in real(objects, variables, binding):
                self.made += bool(variables)
                yield inner

        monkeypatch.setattr(state.Objects, "bindings", counted)

    def spent(self):
        self.before_check.append(self.made)
        self.made = 0
        return super().spent()


MOST = (FREE_PORTIONS + PORTIONS) * PORTION_PARTS
GOAL = "(and {} (forall (?a ?b ?c ?d ?e) (imply (cup-at ?a ?b) (cup-at ?a ?b))))"  # 16807 instances


def test_an_external_plan_for_a_goal_over_many_objects_is_checked_and_reused_over_several_ticks(monkeypatch):
    domain, problem = own("kitchen-s3")
    text = format_plan(solve(domain, problem).plan)
    larger = problem.with_goal(GOAL.format(problem.goal_text))
    budget = MeteredBudget(monkeypatch)
    work = PacedWork(completion(parse_plan(text), domain, larger))
    assert work.advance(budget)
    assert not isinstance(work.result, str)
    reuse = PacedWork(shortest_suffix(work.result, set(), domain, larger))
    assert reuse.advance(budget)
    assert reuse.result is not None
    assert sum(budget.before_check) > 4 * MOST
    assert max(budget.before_check) <= MOST


FLOOD = """(define (domain flood) (:predicates (wet ?a ?b ?c ?d) (g))
  (:action flood :parameters () :effect (and (g) (forall (?a ?b ?c ?d) {}))))"""


@pytest.mark.parametrize("effect", ["(wet ?a ?b ?c ?d)", "(when (wet ?d ?c ?b ?a) (not (wet ?a ?b ?c ?d)))"])
def test_effects_over_many_objects_take_several_ticks(monkeypatch, effect):
    things = " ".join(f"o{n}" for n in range(11))
    domain, problem = read(
        FLOOD.format(effect), f"(define (problem x) (:domain flood) (:objects {things}) (:goal (g)))"
    )
    budget = MeteredBudget(monkeypatch)
    work = PacedWork(completion(parse_plan("1:(flood)\n"), domain, problem))
    assert work.advance(budget)
    linked = work.result
    reuse = PacedWork(shortest_suffix(linked, set(), domain, problem))
    assert reuse.advance(budget)
    assert reuse.result == linked
    assert sum(budget.before_check) > 2 * MOST
    assert max(budget.before_check) <= MOST


def test_the_size_of_effects_is_counted_without_trying_their_objects():
    things = " ".join(f"o{n}" for n in range(11))
    for effect, size in (("(wet ?a ?b ?c ?d)", 14_642), ("(when (not (wet ?d ?c ?b ?a)) (wet ?a ?b ?c ?d))", 43_924)):
        domain, problem = read(
            FLOOD.format(effect), f"(define (problem x) (:domain flood) (:objects {things}) (:goal (g)))"
        )
        fault = too_large_to_execute(parse_plan("1:(flood)\n"), domain, problem)
        assert fault == f"step 1: the effects of (flood) have {size} instances, too many for a tick"
    domain, problem = own("kitchen-s1")
    assert too_large_to_execute(solve(domain, problem).plan, domain, problem) == ""


def test_what_has_too_many_instances_is_not_checked_to_the_end(monkeypatch):
    monkeypatch.setattr(completion_module, "MAX_PARTS", 20_000)
    monkeypatch.setattr(suffix_module, "MAX_PARTS", 20_000)
    domain, problem = own("kitchen-s1")
    plan = solve(domain, problem).plan
    huge = GOAL.replace("?e)", "?e ?f ?g ?h ?i ?j ?k ?l)").format(problem.goal_text)
    fault = PacedWork(completion(plan, domain, problem.with_goal(huge)))
    assert fault.advance(CheckBudget(10**9))
    assert fault.result == "its quantifiers have more than 20000 instances, too many to check"
    suffix = PacedWork(shortest_suffix(plan, set(), domain, problem.with_goal(huge)))
    assert suffix.advance(CheckBudget(10**9))
    assert suffix.result is None
    with pytest.raises(TooLargeError):
        completed_work(validation(plan, domain, Objects(problem.with_goal(huge), most_parts=1000)))
