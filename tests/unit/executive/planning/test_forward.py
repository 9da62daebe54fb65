"""The forward engine: long plans, few orderings, proofs, limits; by turns with partial-order search."""

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import GOAL, Search, Settings, format_links, validate
from tailor.executive.planning.forward import forward_search, justification
from tailor.executive.planning.forward.strips_task import StripsAction
from tests.support.planning.planning_problems import OWN, many_cups, own, read, solve

FORWARD = Settings(engine="forward")
CLASSICAL = [name for name in OWN if "durative" not in name]


@pytest.mark.parametrize("engine", ["forward", "auto"])
def test_twelve_cups_need_four_steps_each(engine):
    domain, problem = many_cups(12)
    plan = solve(domain, problem, Settings(engine=engine)).plan
    assert len(plan.steps) == 48
    assert validate(plan, domain, problem) == ""


def test_a_hand_that_a_needed_step_frees_costs_no_detour():
    result = solve(*many_cups(12), FORWARD)
    assert result.visited == len(result.plan.steps) == 48  # every evaluated state is on the way


def test_partial_order_search_alone_does_not_reach_that_far():
    assert solve(*many_cups(6), Settings(engine="pocl", node_limit=3000)).status == "limit"


@pytest.mark.parametrize("name", CLASSICAL)
def test_every_classical_problem_gets_a_sound_plan_with_all_links(name):
    domain, problem = own(name)
    plan = solve(domain, problem, FORWARD).plan
    assert validate(plan, domain, problem) == ""
    conditions = solve(domain, problem, Settings(engine="pocl")).plan
    linked = {link.literal.fact[0] for link in plan.links}
    assert {link.literal.fact[0] for link in conditions.links_to(GOAL)} <= linked


@pytest.mark.parametrize("name", ["soccer-typed-p3", "kitchen-s3"])
def test_short_problems_keep_the_plan_of_the_partial_order_search(name):
    alone, by_turns = (solve(*own(name), Settings(engine=engine)) for engine in ("pocl", "auto"))
    assert by_turns == alone


def test_independent_steps_stay_unordered():
    domain, problem = read(
        """(define (domain lamps) (:requirements :typing) (:types lamp) (:predicates (on ?l - lamp) (power))
          (:action plug :parameters () :precondition () :effect (power))
          (:action light :parameters (?l - lamp) :precondition (power) :effect (on ?l)))""",
        "(define (problem p) (:domain lamps) (:objects a b c - lamp) (:init) (:goal (and (on a) (on b) (on c))))",
    )
    plan = solve(domain, problem, FORWARD).plan
    plug = next(step.id for step in plan.steps if step.action == ("plug",))
    assert set(plan.orderings) == {(plug, step.id) for step in plan.steps if step.id != plug}
    assert [step.start for step in plan.steps] == [1, 2, 2, 2]


def test_a_step_that_would_undo_a_link_stays_on_its_side():
    domain, problem = read(
        """(define (domain door) (:predicates (open) (in) (locked))
          (:action enter :parameters () :precondition (open) :effect (in))
          (:action lock :parameters () :precondition () :effect (and (locked) (not (open)))))""",
        "(define (problem p) (:domain door) (:init (open)) (:goal (and (in) (locked))))",
    )
    plan = solve(domain, problem, FORWARD).plan
    assert [step.action for step in plan.steps] == [("enter",), ("lock",)]
    assert len(plan.orderings) == 1


def test_an_exhausted_state_space_proves_that_there_is_no_plan():
    domain, problem = own("kitchen-s3")
    both_held = problem.with_goal("(and (holding cup1) (holding cup2))")
    assert solve(domain, both_held, FORWARD).status == "unsolvable"
    assert solve(domain, both_held, Settings(engine="auto")).status == "unsolvable"


@pytest.mark.parametrize("goal", ["(cup-at cup1 nowhere)", "(and (hand-empty) (not (hand-empty)))", "(or)"])
def test_a_goal_that_is_false_in_every_state_has_no_plan(goal):
    domain, problem = read(
        """(define (domain d) (:predicates (hand-empty) (cup-at ?cup ?place)) (:constants cup1 nowhere)
          (:action release :parameters () :effect (hand-empty)))""",
        f"(define (problem p) (:domain d) (:init) (:goal {goal}))",
    )
    assert solve(domain, problem, FORWARD).status == "unsolvable"


def test_the_limit_of_states_ends_the_search():
    result = solve(*many_cups(8), Settings(engine="forward", node_limit=10))
    assert (result.status, result.visited) == ("limit", 10)


def test_durations_are_refused_by_name():
    result = solve(*own("kitchen-durative-s1"), FORWARD)
    assert result.status == "unsupported"
    assert "durations" in result.reason


def test_a_plan_beyond_the_limit_of_steps_is_none():
    assert solve(*many_cups(3), Settings(engine="forward", step_limit=11)).status == "limit"


def test_the_division_into_portions_changes_nothing():
    domain, problem = many_cups(5)
    whole = solve(domain, problem, Settings())
    search = Search(domain, problem, Settings())
    while (result := search.advance(CheckBudget(7))) is None:
        pass
    assert result == whole
    assert format_links(result.plan) == format_links(whole.plan)


def grid_to_clear(objects):
    """A goal of (objects ** 2) literals, of which all but two hold already."""
    return read(
        "(define (domain d) (:predicates (p ?x ?y)) (:action a :parameters (?x ?y) :effect (not (p ?x ?y))))",
        f"(define (problem t) (:domain d) (:objects {' '.join(f'o{n}' for n in range(objects))}) "
        "(:init (p o1 o2) (p o2 o3)) (:goal (forall (?x ?y) (not (p ?x ?y)))))",
    )


def test_partial_order_search_has_no_head_start_where_the_goal_alone_needs_thousands_of_refinements():
    result = solve(*grid_to_clear(40), Settings())
    assert (result.status, len(result.plan.steps)) == ("solved", 2)
    assert result.visited < 30


def test_what_is_too_large_for_lifted_planning_is_named():
    result = solve(*grid_to_clear(150), Settings(ground=False, ground_limit=300_000))
    assert result.reason == "grounding takes more than its limit of 50000 steps, spent at the goal"


def doubling(levels):
    """A chain where each level needs two facts of the one before: additive costs double from level to level."""
    names = range(levels)
    actions = " ".join(
        f"(:action {x}{n} :precondition (and (p{n}) (q{n})) :effect ({x}{n + 1}))" for n in names for x in "pq"
    )
    predicates = " ".join(f"(p{n}) (q{n})" for n in range(levels + 1))
    return read(
        f"(define (domain d) (:predicates {predicates}) {actions})",
        f"(define (problem x) (:domain d) (:init (p0) (q0)) (:goal (p{levels})))",
    )


@pytest.mark.parametrize("engine", ["forward", "auto", "pocl"])
def test_costs_that_double_from_level_to_level_fill_no_memory_and_are_no_proof(engine):
    domain, problem = doubling(90)
    plan = solve(domain, problem, Settings(engine=engine)).plan
    assert len(plan.steps) == 179
    assert validate(plan, domain, problem) == ""


def test_costs_beyond_all_floats_are_no_proof():
    assert solve(*doubling(1100), Settings(engine="pocl", step_limit=10)).status == "limit"


WIDE = """(define (domain wide) (:predicates (p ?x ?y) (g ?x)) (:action a :parameters (?x ?y) :effect (p ?x ?y))
  (:action b :parameters (?x) :precondition (forall (?y) (p ?x ?y)) :effect (g ?x)))"""


def wide(count):
    """A problem of count ** 2 + count steps in any order."""
    objects = [f"o{n}" for n in range(count)]
    goal = " ".join(f"(g {name})" for name in objects)
    return read(WIDE, f"(define (problem x) (:domain wide) (:objects {' '.join(objects)}) (:goal (and {goal})))")


def test_a_long_sequence_is_shortened_in_portions(monkeypatch):
    tried, before_check, real = [0], [], StripsAction.applies

    def counted(action, state):
        tried[0] += 1
        return real(action, state)

    class MeteredBudget(CheckBudget):
        def spent(self):
            before_check.append(tried[0])
            tried[0] = 0
            return super().spent()

    monkeypatch.setattr(StripsAction, "applies", counted)
    result = Search(*wide(16), FORWARD).advance(MeteredBudget(10**9))
    assert result.reason == "no plan of up to 200 steps"
    assert sum(before_check) > 30_000
    assert max(before_check) <= justification.PORTION


def test_states_that_wait_do_not_fill_the_memory(monkeypatch):
    monkeypatch.setattr(forward_search, "MAX_ENTRIES", 2000)
    result = solve(*wide(8), FORWARD)
    assert (result.status, result.reason) == ("limit", "the queued states take too much memory")
