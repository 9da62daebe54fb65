"""Partial-order plans: the truth criterion and the walk against all permutations, each simulated by the validator."""

from dataclasses import replace
from itertools import permutations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive.planning import Plan, Step, UndecidedError, validate, validate_every_order
from tailor.executive.planning.orders import every_order
from tests.property.test_planning_soundness import (
    FORWARD,
    GOALS,
    LITERALS,
    OPTIONS,
    PLAIN_EFFECT,
    RELAXED,
    RICH,
    RICH_EFFECT,
    SIMPLE,
    conjunction,
    problems,
)
from tests.support.planning.planning_problems import OWN, own, read, solve

INDEXES = range(4)
STEPS = st.lists(st.tuples(st.integers(0, 2), st.sampled_from("ab"), st.sampled_from("ab")), max_size=4)
PAIRS = st.lists(st.sampled_from([(i, j) for i, j in product(INDEXES, INDEXES) if i < j]), max_size=5)


def partial_plan(problem, drawn, pairs):
    """A plan of steps 1, 2, ... without links."""
    names = [f"a{n}" for n in range(len(problem.domain.actions))]
    steps = [Step(n, (names[k % len(names)], x, y), float(n)) for n, (k, x, y) in enumerate(drawn, 1)]
    orderings = {(i + 1, j + 1) for i, j in pairs if j < len(steps)}
    return Plan(problem.name, problem.initial, tuple(steps), (), tuple(sorted(orderings)))


def sound_by_force(plan, domain, problem):
    for order in permutations(plan.steps):
        place = {step.id: n for n, step in enumerate(order)}
        if all(place[i] < place[j] for i, j in plan.orderings):
            timed = tuple(replace(step, start=float(n)) for n, step in enumerate(order, 1))
            if validate(replace(plan, steps=timed), domain, problem):
                return False
    return True


# conditions that often hold, so that many random plans are sound
EASY = problems(st.lists(st.sampled_from(["(p ?x)", "(not (q ?y))", "(r)"]), max_size=1).map(conjunction), PLAIN_EFFECT,
                st.lists(LITERALS, min_size=1, max_size=1).map(conjunction))  # fmt: skip


@pytest.mark.parametrize("drawn", [EASY, problems(SIMPLE, PLAIN_EFFECT, GOALS), problems(RICH, RICH_EFFECT, GOALS)])
def test_the_verdict_is_that_of_all_permutations(drawn):
    verdicts = []

    @RELAXED
    @given(drawn, STEPS, PAIRS)
    def check(texts, steps, pairs):
        domain, problem = read(*texts)
        plan = partial_plan(problem, steps, pairs)
        fault = validate_every_order(plan, domain, problem)
        assert (not fault) == sound_by_force(plan, domain, problem), fault
        verdicts.append(not fault)

    check()
    assert any(verdicts)
    assert not all(verdicts)


@pytest.mark.parametrize("options", [*OPTIONS.values(), FORWARD], ids=[*OPTIONS, "forward"])
def test_every_order_of_a_plan_that_a_search_finds_is_sound(options):
    @RELAXED
    @given(problems(RICH, RICH_EFFECT, GOALS))
    def check(texts):
        domain, problem = read(*texts)
        plan = solve(domain, problem, options).plan
        assert plan is None or validate_every_order(plan, domain, problem) == ""

    check()


@pytest.mark.parametrize("name", [name for name in OWN if "durative" not in name])
def test_every_order_of_our_problems_plans_is_sound_and_needs_its_orderings(name):
    domain, problem = own(name)
    plan = solve(domain, problem).plan
    assert validate_every_order(plan, domain, problem) == ""
    assert validate_every_order(replace(plan, orderings=()), domain, problem)


def test_a_cycle_and_unknown_actions_are_faults():
    domain, problem = own("kitchen-s1")
    plan = solve(domain, problem).plan
    (i, j), *_ = plan.orderings
    assert "cycle" in validate_every_order(replace(plan, orderings=((i, j), (j, i))), domain, problem)
    odd = (Step(1, ("fly",), 1.0),)
    assert "no action" in validate_every_order(replace(plan, steps=odd), domain, problem)


def test_the_criterion_decides_what_has_too_many_orders_to_walk_through(monkeypatch):
    facts = " ".join(f"(d{n})" for n in range(30))
    actions = " ".join(f"(:action a{n} :parameters () :effect (d{n}))" for n in range(30))
    texts = (f"(define (domain many) (:predicates {facts}) {actions})",
             f"(define (problem p) (:domain many) (:init) (:goal (and {facts})))")  # fmt: skip
    domain, problem = read(*texts)
    plan = Plan("p", (), tuple(Step(n + 1, (f"a{n}",), 1.0) for n in range(30)))
    assert validate_every_order(plan, domain, problem) == ""
    monkeypatch.setattr(every_order, "MAX_STATES", 1000)
    domain, problem = read(texts[0].replace(":effect (d0)", ":effect (when (d1) (d0))"), texts[1])
    problem = problem.with_goal("(d29)")
    with pytest.raises(UndecidedError):
        validate_every_order(plan, domain, problem)


def test_plans_with_durations_are_refused():
    domain, problem = own("kitchen-durative-s1")
    with pytest.raises(ValueError, match="schedule"):
        validate_every_order(Plan("p", (), ()), domain, problem)
