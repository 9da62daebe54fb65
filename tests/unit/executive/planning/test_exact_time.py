"""Durations are exact: whatever the tolerance, plans are sound, last what PDDL asks, and are printed in full."""

import math
import random

import pytest

from tailor.executive.planning import MATCHING, Settings, format_links, format_plan, parse_plan, validate
from tailor.executive.planning.ground.durations import TimeGrid, duration_range, time_grid
from tailor.executive.planning.ground.grounding import static_world
from tailor.executive.planning.pddl.language import DurationBound, Function, Number, Operation
from tailor.executive.planning.semantics.durations import allowed_durations
from tests.support.planning.planning_problems import OWN, own, read, solve

TOLERANCES = (1e-6, 0.001, 0.01, 0.25, 0.3, 0.5, 1, 7, 1000)
DURATIVE = [name for name in OWN if "durative" in name]

FACTORY = """(define (domain factory) (:requirements :durative-actions :duration-inequalities :timed-initial-literals)
  (:predicates (part ?x) (cut ?x) (hot) (done ?x) (open)) (:functions (length ?x) (speed))
  (:durative-action cut :parameters (?x) :duration (= ?duration (/ (length ?x) (speed)))
    :condition (at start (part ?x)) :effect (at end (cut ?x)))
  (:durative-action heat :parameters () :duration (and (>= ?duration 1.4) (<= ?duration 2.7182))
    :condition (over all (open)) :effect (and (at start (hot)) (at end (not (hot)))))
  (:durative-action weld :parameters (?x) :duration (= ?duration 0.0625)
    :condition (and (at start (cut ?x)) (over all (hot))) :effect (at end (done ?x))))"""
TASK = """(define (problem p) (:domain factory) (:objects a b)
  (:init (part a) (part b) (= (speed) 0.7) (= (length a) 1) (= (length b) 2.1) (at 0.333 (open)))
  (:goal (and (done a) (done b))))"""


@pytest.mark.parametrize("tolerance_s", TOLERANCES)
@pytest.mark.parametrize("name", [*DURATIVE, "factory"])
@pytest.mark.parametrize("ground", [True, False])
def test_plans_are_sound_whatever_the_tolerance(name, tolerance_s, ground):
    if not ground and name in ("soccer-durative-p2", "soccer-durative-p3", "kitchen-durative-s2"):
        pytest.skip("many plans when lifted")
    domain, problem = read(FACTORY, TASK) if name == "factory" else own(name)
    plan = solve(
        domain, problem, Settings(MATCHING.rankings, MATCHING.flaw_orders, ground=ground, tolerance_s=tolerance_s)
    ).plan
    assert validate(plan, domain, problem) == ""
    for text in (format_links(plan), format_plan(plan)):
        assert validate(parse_plan(text), domain, problem) == ""


def test_durations_are_printed_with_the_digits_they_need():
    domain, problem = read(FACTORY, TASK)
    for tolerance_s in (0.01, 0.25, 1):
        plan = solve(domain, problem, Settings(tolerance_s=tolerance_s)).plan
        durations = {step.action: step.duration for step in plan.steps}
        assert durations["cut", "b"] == 3
        assert durations["cut", "a"] == 1.428571429  # 10/7, to the nanosecond
        assert durations["weld", "a"] == 0.0625
        assert 1.4 <= durations["heat",] <= 2.7182
        assert "(cut a)[1.428571429]" in format_plan(plan)
        assert "(weld a)[0.0625]" in format_plan(plan)


def test_dependent_events_are_a_tolerance_apart():
    domain, problem = own("soccer-durative-p1")
    for tolerance_s in (0.001, 0.01, 0.3):
        plan = solve(domain, problem, Settings(tolerance_s=tolerance_s)).plan
        steps = {step.id: step for step in plan.steps}
        gaps = [steps[j].start - steps[i].start - steps[i].duration for i, j in plan.orderings]
        assert min(gaps) == pytest.approx(tolerance_s)


def test_the_grid_holds_the_tolerance_all_durations_and_times():
    grid = time_grid(0.01, [(1_400_000_000, 1_400_000_000), (25_000_000, None)], [0.5])
    assert grid == TimeGrid(5_000_000, 2)
    assert grid.units(0.5) == 100
    assert grid.seconds(281) == 1.405
    assert time_grid(0.01, [(0, 0), (3 * 10**9, 3 * 10**9)], []) == TimeGrid(10**7, 1)
    assert time_grid(1, [(4 * 10**8, 4 * 10**8)], []) == TimeGrid(2 * 10**8, 2)  # no longer than the shortest action


def test_a_duration_with_limits_lies_within_them():
    grid = TimeGrid(10**7, 1)
    assert grid.duration((0, 0)) == (0, 0)
    assert grid.duration((0, 5 * 10**7)) == (1, 5)  # what may take time takes a tick
    assert grid.duration((15_000_000, None)) == (2, None)
    assert grid.duration((15_000_000, 17_000_000)) is None


def test_long_durations_beside_short_ones_are_exact():
    domain = """(define (domain d) (:requirements :durative-actions) (:predicates (p) (q))
      (:durative-action long :parameters () :duration (= ?duration 900000000) :effect (at end (p)))
      (:durative-action short :parameters () :duration (= ?duration 0.000001)
        :condition (at start (p)) :effect (at end (q))))"""
    task = "(define (problem x) (:domain d) (:init) (:goal (q)))"
    domain, problem = read(domain, task)
    plan = solve(domain, problem).plan
    assert validate(plan, domain, problem) == ""
    assert math.isclose(plan.makespan, 900000000.01, abs_tol=0.02)


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize(("longer", "shorter", "tick_s"), [("10.005", "9.99", 0.01), ("3", "1.5", 1), ("3", "2", 1)])
def test_a_condition_over_all_is_kept_up_to_the_last_part_of_a_tick(longer, shorter, tick_s, ground):
    """The shorter action cannot end a whole tick before the longer one, which it would disturb, but a part of it."""
    domain, problem = read(
        f"""(define (domain d) (:requirements :durative-actions) (:predicates (shut) (begun) (baked) (aired))
          (:durative-action bake :parameters () :duration (= ?duration {longer}) :condition (over all (shut))
            :effect (and (at start (begun)) (at end (baked))))
          (:durative-action air :parameters () :duration (= ?duration {shorter}) :condition (at start (begun))
            :effect (and (at end (not (shut))) (at end (aired)))))""",
        "(define (problem x) (:domain d) (:init (shut)) (:goal (and (baked) (aired))))",
    )
    plan = solve(domain, problem, Settings(tolerance_s=tick_s, ground=ground)).plan
    assert validate(plan, domain, problem) == ""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_a_step_that_starts_in_the_last_part_of_another_ones_last_tick_is_not_ordered_after_it(ground):
    domain, problem = read(
        """(define (domain d) (:requirements :durative-actions) (:predicates (begun) (g) (h))
          (:durative-action one :parameters () :duration (= ?duration 1.5)
            :effect (and (at start (begun)) (at end (g))))
          (:durative-action two :parameters () :duration (= ?duration 1.5) :condition (at start (begun))
            :effect (at end (h))))""",
        "(define (problem x) (:domain d) (:init) (:goal (and (g) (h))))",
    )
    plan = solve(domain, problem, Settings(tolerance_s=1, ground=ground)).plan
    assert [(step.action, step.start) for step in plan.steps] == [(("one",), 1), (("two",), 2)]
    assert plan.orderings == ()
    assert parse_plan(format_links(plan)).orderings == ()


@pytest.mark.parametrize("duration", ["(/ 10000 3)", "(/ 999999999 7)", "(* 1e9 0.999999999)"])
def test_a_long_plan_in_nanoseconds_is_read_back(duration):
    domain, problem = read(
        f"""(define (domain d) (:requirements :durative-actions) (:predicates (p) (q))
          (:durative-action one :parameters () :duration (= ?duration {duration}) :effect (at end (p)))
          (:durative-action two :parameters () :duration (= ?duration (/ 1 3)) :condition (at start (p))
            :effect (at end (q))))""",
        "(define (problem x) (:domain d) (:init) (:goal (q)))",
    )
    plan = solve(domain, problem).plan
    assert parse_plan(format_links(plan)) == plan


# --- the validator works durations out by itself; it agrees with the search, which it does not share ---
VALUES = {("distance", "a", "b"): 4.0, ("speed",): 0.5, ("zero",): 0.0}
BINDING = {"?from": "a", "?to": "b"}


def allowed(*bounds):
    return allowed_durations(tuple(DurationBound(*bound) for bound in bounds), BINDING, VALUES)


def test_a_duration_is_worked_out_from_static_functions():
    distance, speed = Function("distance", ("?from", "?to")), Function("speed", ())
    assert allowed(("=", Operation("/", (distance, speed)))) == (8.0, 8.0)
    assert allowed((">=", distance), ("<=", Number(10.0))) == (4.0, 10.0)
    assert allowed((">=", Operation("-", (Number(1.0), distance, speed)))) == (0.0, math.inf)
    assert allowed() == (0.0, math.inf)


@pytest.mark.parametrize(
    "bounds",
    [
        [("=", Function("distance", ("?to", "?from")))],
        [("=", Operation("/", (Number(1.0), Function("zero", ()))))],
        [(">=", Number(5.0)), ("<=", Number(4.0))],
    ],
)
def test_no_value_a_division_by_zero_or_an_empty_interval_allow_no_duration(bounds):
    assert allowed(*bounds) is None


def numeric(rng, depth):
    if depth == 0 or rng.random() < 0.3:
        leaf = rng.choice([Number(rng.choice([0.0, 1.0, -2.5, 1e9])), *(Function(n, t) for n, *t in VALUES)])
        return Function(leaf.name, tuple(leaf.terms)) if isinstance(leaf, Function) else leaf
    return Operation(rng.choice("+-*/"), tuple(numeric(rng, depth - 1) for _ in range(rng.randint(2, 4))))


def test_validator_and_search_agree_on_random_durations():
    _, problem = own("soccer-durative-p1")
    world, rng = static_world(problem), random.Random(1)
    world = type(world)(world.domain, world.objects, world.static, world.facts, VALUES, world.temporal)
    for _ in range(500):
        bounds = tuple(DurationBound(rng.choice(["=", "<=", ">="]), numeric(rng, 3)) for _ in range(rng.randint(1, 3)))
        assert allowed_durations(bounds, BINDING, VALUES) == duration_range(bounds, BINDING, world)


@pytest.mark.parametrize("ground", [True, False])
@pytest.mark.parametrize(("duration", "cost"), [("{}", "1"), ("1", "{}")])
@pytest.mark.parametrize("factors", [2, 40])
def test_a_duration_or_cost_beyond_all_bounds_is_refused_by_its_action(duration, cost, factors, ground):
    huge = "(* 1e9 " * factors + "1" + ")" * factors
    domain = f"""(define (domain d) (:predicates (p)) (:functions (total-cost)) (:durative-action act :parameters ()
      :duration (= ?duration {duration.format(huge)})
      :effect (and (at end (p)) (at end (increase (total-cost) {cost.format(huge)})))))"""
    texts = (domain, "(define (problem x) (:domain d) (:init) (:goal (p)) (:metric minimize (total-cost)))")
    result = solve(*read(*texts), Settings(ground=ground))
    assert (result.status, result.reason) == ("limit", "the duration or the cost of 'act' is above 1e+09")


def test_an_upper_limit_that_no_float_holds_is_none():
    duration = f"(and (>= ?duration 1) (<= ?duration (* {'1e9 ' * 40})))"
    domain, problem = read(
        "(define (domain d) (:predicates (g))"
        f" (:durative-action a :parameters () :duration {duration} :effect (at end (g))))",
        "(define (problem p) (:domain d) (:init) (:goal (g)))",
    )
    plan = solve(domain, problem).plan
    assert plan.makespan == pytest.approx(1.01)
    assert validate(plan, domain, problem) == ""
