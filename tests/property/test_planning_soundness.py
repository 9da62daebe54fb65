"""Comparison with brute force on small random problems: plans are sound, and unsolvable problems have no plan."""

from dataclasses import replace
from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tailor.executive.planning import FlawOrder, Settings, validate
from tailor.executive.planning.semantics.action_effects import apply_action
from tailor.executive.planning.semantics.state import Objects, holds
from tests.support.planning.planning_problems import read, solve

FACTS = ["(p a)", "(p b)", "(q a)", "(q b)", "(r)"]
LITERALS = st.sampled_from(FACTS + [f"(not {fact})" for fact in FACTS])
VARIABLE_LITERALS = st.sampled_from(["(p ?x)", "(q ?x)", "(p ?y)", "(not (p ?x))", "(not (q ?y))", "(r)", "(not (r))"])
TEMPLATE = """(define (domain random) (:requirements :adl) (:predicates (p ?o) (q ?o) (r))
  {actions})"""
PROBLEM = "(define (problem p) (:domain random) (:objects a b) (:init {initial}) (:goal {goal}))"


def conjunction(literals):
    return f"(and {' '.join(literals)})"


def schema(number, condition, effects):
    return f"(:action a{number} :parameters (?x ?y) :precondition {condition} :effect {conjunction(effects)})"


SIMPLE = st.lists(VARIABLE_LITERALS, max_size=2).map(conjunction)
RICH = st.one_of(
    SIMPLE,
    st.builds("(or {} {})".format, VARIABLE_LITERALS, SIMPLE),
    st.builds("(forall (?y) {})".format, SIMPLE),
    st.builds("(exists (?y) {})".format, SIMPLE),
    st.builds("(not {})".format, SIMPLE),
)
PLAIN_EFFECT = st.lists(VARIABLE_LITERALS, min_size=1, max_size=3)
RICH_EFFECT = st.lists(
    st.one_of(VARIABLE_LITERALS, st.builds("(when {} {})".format, SIMPLE, VARIABLE_LITERALS),
              st.builds("(forall (?y) {})".format, VARIABLE_LITERALS)), min_size=1, max_size=3)  # fmt: skip


def problems(condition, effect, goal):
    actions = st.lists(st.tuples(condition, effect), min_size=1, max_size=3)
    initial = st.lists(st.sampled_from(FACTS), max_size=3)
    return st.tuples(
        actions.map(lambda a: TEMPLATE.format(actions=" ".join(schema(n, c, e) for n, (c, e) in enumerate(a)))),
        st.builds(lambda i, g: PROBLEM.format(initial=" ".join(i), goal=g), initial, goal),
    )


GOALS = st.lists(LITERALS, min_size=1, max_size=2).map(conjunction)


def solvable(domain, problem):
    """Whether forward search through all states reaches the goal."""
    objects = Objects(problem)
    actions = [(a, names) for a in domain.actions for names in product("ab", repeat=len(a.parameters))]
    seen, pending = {frozenset(problem.initial)}, [frozenset(problem.initial)]
    while pending:
        state = pending.pop()
        if holds(problem.goal, {}, state, objects):
            return True
        for action, names in actions:
            binding = dict(zip((p.name for p in action.parameters), names, strict=True))
            if all(holds(condition.formula, binding, state, objects) for condition in action.conditions):
                after = apply_action(domain, problem, state, (action.name, *names))
                if after not in seen:
                    seen.add(after)
                    pending.append(after)
    return False


def agrees(texts, options):
    """The verdict is the brute force's, or a limit."""
    domain, problem = read(*texts)
    result = solve(domain, problem, options)
    possible = solvable(domain, problem)
    if result.status == "solved":
        assert possible
        assert validate(result.plan, domain, problem) == ""
    else:
        assert result.status == "limit" or not possible, result.reason


OPTIONS = {
    "round-robin": Settings(node_limit=400, engine="pocl"),
    "IDA": Settings(node_limit=400, engine="pocl", search="IDA", flaw_orders=(FlawOrder("UCPOP"),)),
    "lifted": Settings(node_limit=300, ground=False, engine="pocl"),
    "by-turns": Settings(node_limit=400),
}
RELAXED = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@pytest.mark.parametrize("options", OPTIONS.values(), ids=OPTIONS)
def test_planning_agrees_with_brute_force(options):
    @RELAXED
    @given(problems(RICH, RICH_EFFECT, GOALS))
    def check(texts):
        agrees(texts, options)

    check()


def test_lifted_planning_of_plain_actions_agrees_with_brute_force():
    @RELAXED
    @given(problems(SIMPLE, PLAIN_EFFECT, GOALS))
    def check(texts):
        agrees(texts, OPTIONS["lifted"])

    check()


# --- search through states -----------------------------------------------------------------------
FORWARD = Settings(engine="forward", node_limit=400)


@RELAXED
@given(problems(SIMPLE, PLAIN_EFFECT, GOALS))
def test_search_through_states_agrees_with_brute_force(texts):
    agrees(texts, FORWARD)


@RELAXED
@given(problems(SIMPLE, PLAIN_EFFECT, st.lists(st.sampled_from(["(p a)", "(p b)", "(q a)", "(not (r))"]), min_size=3,
                                               max_size=4).map(lambda goals: f"(and {' '.join(goals)})")),
       st.randoms(use_true_random=False))  # fmt: skip
def test_every_order_that_the_plan_leaves_open_is_sound(texts, random):
    domain, problem = read(*texts)
    plan = solve(domain, problem, FORWARD).plan
    if plan is None:
        return
    waiting, order = {step.id: step for step in plan.steps}, []
    while waiting:
        ready = [i for i in waiting if not any(j in waiting for j, k in plan.orderings if k == i)]
        order.append(waiting.pop(random.choice(ready)))
    shuffled = tuple(replace(step, start=float(n)) for n, step in enumerate(order, 1))
    assert validate(replace(plan, steps=shuffled), domain, problem) == ""
