"""The search: results are values, work is resumable and repeatable, every option does what it says."""

import dataclasses
import weakref

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import (
    DEFAULT,
    MATCHING,
    FlawOrder,
    GroundCache,
    Search,
    Settings,
    format_links,
    parse_plan,
    validate,
)
from tailor.executive.planning.flaws.flaw_orders import NAMED, parse_flaw_order
from tailor.executive.planning.flaws.ranking import NAMES
from tailor.runtime.gc_freeze import gc_disabled
from tailor.schemas.errors import UsageError
from tests.support.planning.planning_problems import own, read, solve

DOOR = """(define (domain door) (:predicates (open) (shut) (in))
  (:action enter :parameters () :precondition (and (open) (shut)) :effect (in))
  (:action close :parameters () :precondition (open) :effect (and (shut) (not (open))))
  (:action open :parameters () :precondition (shut) :effect (and (open) (not (shut)))))"""


def door(goal, initial="(open)"):
    return read(DOOR, f"(define (problem p) (:domain door) (:init {initial}) (:goal {goal}))")


# --- results are values --------------------------------------------------------------------------
def test_what_no_relaxed_plan_reaches_is_proven_unsolvable():
    result = solve(*door("(in)", initial=""))
    assert (result.status, result.plan) == ("unsolvable", None)
    assert "cannot be reached" in result.reason


def test_a_search_that_runs_dry_proves_unsolvable():
    domain, problem = read(
        """(define (domain once) (:predicates (fresh) (a) (b))
          (:action a :parameters () :precondition (fresh) :effect (and (a) (not (fresh))))
          (:action b :parameters () :precondition (fresh) :effect (and (b) (not (fresh)))))""",
        "(define (problem p) (:domain once) (:init (fresh)) (:goal (and (a) (b))))",
    )
    result = solve(domain, problem)
    assert result.status == "unsolvable"
    assert "dead end" in result.reason


def test_a_goal_that_contradicts_itself_is_proven_unsolvable_at_once():
    result = solve(*door("(and (open) (not (open)))"))
    assert (result.status, result.visited) == ("unsolvable", 0)


@pytest.mark.parametrize("kind", ["action", "durative-action"])
def test_an_action_whose_conditions_contradict_each_other_is_no_way(kind):
    timed = kind != "action"
    start, end = ("(at start ", "(at end ") if timed else ("(", "(")
    parts = (":duration (= ?duration 1) :condition", ":effect") if timed else (":precondition", ":effect")
    literal = f"{start}(p ?x)) {start}(not (p ?y)))" if timed else "(p ?x) (not (p ?y))"
    made = f"{end}(q ?x ?y))" if timed else "(q ?x ?y)"
    domain = f"""(define (domain d) (:predicates (p ?x) (q ?x ?y))
      (:{kind} a :parameters (?x ?y) {parts[0]} (and {literal}) {parts[1]} {made}))"""
    task = "(define (problem x) (:domain d) (:objects a b) (:init (p a)) (:goal (q a {})))"
    assert solve(*read(domain, task.format("a"))).status == "unsolvable"
    assert solve(*read(domain, task.format("b"))).status == "solved"


def test_an_endless_search_ends_at_its_limit():
    result = solve(*door("(in)"), dataclasses.replace(MATCHING, node_limit=500))
    assert result.status == "limit"
    assert 500 <= result.generated < 520


def test_every_flaw_order_may_have_a_limit_of_its_own_which_it_never_exceeds():
    for first in (50, 51, 52):
        settings = Settings(flaw_orders=(FlawOrder("UCPOP", first), FlawOrder("LCFR", 70)), engine="pocl")
        result = solve(*door("(in)"), settings)
        assert (result.status, result.generated) == ("limit", first + 70)


def test_goals_that_hold_already_need_no_step():
    result = solve(*door("(open)"))
    assert (result.status, result.plan.steps) == ("solved", ())


def test_a_ranking_that_loves_long_plans_ends_at_their_longest():
    result = solve(*door("(in)"), Settings(("LIFO",), step_limit=30, node_limit=3000, engine="pocl"))
    assert result.status == "limit"


def test_too_much_to_ground_is_a_limit():
    domain, problem = own("kitchen-s3")
    assert solve(domain, problem, Settings(ground_limit=10)).status == "limit"


# --- resumable, repeatable -----------------------------------------------------------------------
@pytest.mark.parametrize("checks", [1, 7, 100])
@pytest.mark.parametrize("settings", [MATCHING, DEFAULT, Settings(search="IDA")], ids=["A", "round-robin", "IDA"])
def test_a_search_in_slices_is_the_same_search(checks, settings):
    domain, problem = own("kitchen-s2")
    whole = solve(domain, problem, settings)
    search, result, slices = Search(domain, problem, settings), None, 0
    while result is None:
        budget = CheckBudget(checks)
        result = search.advance(budget)
        assert budget.granted <= checks
        slices += 1
    assert result == whole
    assert slices > 1 or checks == 100
    assert search.advance(CheckBudget(0)) == result


@pytest.mark.parametrize("engine", ["pocl", "forward", "auto"])
@pytest.mark.parametrize("checks", [3, 100_000])
def test_an_abandoned_search_is_freed_without_a_collection(engine, checks):
    """Else its plans stay beside those of the next one until all that is alive has been visited."""
    with gc_disabled():
        search = Search(*own("kitchen-s2"), dataclasses.replace(DEFAULT, engine=engine))
        result = search.advance(CheckBudget(checks))
        assert (result is None) == (checks == 3)
        held = weakref.ref(search._course)
        del search, result
        assert held() is None


def test_an_empty_budget_does_nothing():
    search = Search(*own("kitchen-s1"))
    assert search.advance(CheckBudget(0)) is None
    assert search.counts == (0, 0)


def test_same_seed_same_plan_and_another_seed_may_differ():
    settings = [Settings(flaw_orders=(FlawOrder("{n,s,o}R"),), seed=seed) for seed in (1, 1, 2, 3)]
    results = [solve(*own("kitchen-s2"), s) for s in settings]
    assert results[0] == results[1]
    assert len({result.generated for result in results}) > 1


def test_random_open_conditions_shuffle_but_stay_sound():
    domain, problem = own("soccer-typed-p2")
    settings = [dataclasses.replace(MATCHING, random_open_conditions=True, seed=seed) for seed in range(4)]
    results = [solve(domain, problem, s) for s in settings]
    assert all(validate(result.plan, domain, problem) == "" for result in results)
    assert len({result.generated for result in results}) > 1


def test_grounding_is_done_once_while_the_world_stands():
    domain, problem = own("kitchen-s2")
    cache = GroundCache()
    checks = []
    moved = [("robot-at", "table2"), *(fact for fact in problem.initial if fact[0] != "robot-at")]
    for now in (problem, problem.with_initial(moved)):
        budget = CheckBudget(10**6)
        result = Search(domain, now, MATCHING, cache).advance(budget)
        assert validate(result.plan, domain, now) == ""
        checks.append(cache.last)
    assert checks[0] is checks[1]
    Search(domain, dataclasses.replace(problem, objects=problem.objects[:-1]), MATCHING, cache).advance(CheckBudget(10))
    assert cache.last is not checks[0]


def test_another_goal_over_the_same_objects_is_planned_from_the_same_grounding():
    domain, problem = own("kitchen-s2")
    cache = GroundCache()
    for goal in ("(holding cup1)", "(and (cup-at cup2 table2) (not (hand-empty)))", "(robot-at table2)"):
        now = problem.with_goal(goal)
        result = Search(domain, now, MATCHING, cache).advance(CheckBudget(10**6))
        assert validate(result.plan, domain, now) == ""
        assert now.goal_text == goal


# --- options -------------------------------------------------------------------------------------
@pytest.mark.parametrize("name", NAMED)
def test_every_named_flaw_order_plans(name):
    domain, problem = own("kitchen-s1")
    for ground in (True, False):
        result = solve(domain, problem, Settings(flaw_orders=(FlawOrder(name),), ground=ground, node_limit=20_000))
        assert validate(result.plan, domain, problem) == ""


@pytest.mark.parametrize("name", [n for n in NAMES if n not in ("FIFO", "LIFO", "OC", "UC", "BUC")])
@pytest.mark.parametrize("problem_name", ["soccer-p1", "kitchen-durative-s1"])
def test_every_ranking_plans(name, problem_name):
    domain, problem = own(problem_name)
    first = (
        ("UCPOP",) if name in ("ADD_COST", "ADD_WORK", "ADDR_COST", "ADDR_WORK", "MAKESPAN") else ()
    )  # blind to steps
    result = solve(domain, problem, Settings((*first, name), node_limit=20_000))
    assert result.status == "solved"
    assert validate(result.plan, domain, problem) == ""


@pytest.mark.parametrize("name", ["FIFO", "OC", "UC", "BUC"])
def test_uninformed_rankings_work_as_tie_breakers(name):
    result = solve(*own("soccer-p1"), Settings(("ADD", name)))
    assert len(result.plan.steps) == 2


OWN_ORDERS = ["{o}LIFO", "{o}FIFO", "{o}MR", "{o}NEW/{o}LR", "{o}REUSE", "{o}LC_addr", "{o}MC_addr", "{o}MW_makespan",
              "{u}LW_makespan/{o}LR", "{t}LIFO/{o}2LR/{o}LIFO"]  # fmt: skip


@pytest.mark.parametrize("criterion", OWN_ORDERS)
def test_own_flaw_orders_plan(criterion):
    domain, problem = own("kitchen-s1")
    result = solve(domain, problem, Settings(flaw_orders=(FlawOrder("{n}0LR/{n,s}LR/" + criterion),)))
    assert validate(result.plan, domain, problem) == ""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("NOPE", "expected a name"),
        ("{n,s}LR", "some flaws are never selected"),
        ("{n,s}LR/{o}0LR", "some flaws are never selected"),
        ("{n,s,x}LR/{o}LR", "unknown flaw type 'x'"),
        ("{n,s}LR/{o}XX", "unknown criterion 'XX'"),
        ("{n,s}LR/{o}MW", "take _add"),
        ("{n,s}LR/{o}LR_add", "take _add"),
        ("{n,s}NEW/{o}LR", "orders open conditions, not threats"),
        ("{n}" + "9" * 5000 + "LR/{n,s,o}LR", "found '{n}" + "9" * 54 + "...'"),
    ],
)
def test_malformed_flaw_orders_are_told(text, message):
    with pytest.raises(UsageError) as caught:
        parse_flaw_order(text)
    assert message in str(caught.value)


def test_unknown_rankings_and_bad_settings_are_told():
    with pytest.raises(UsageError, match="ranking 'FOO' is unknown"):
        solve(*own("soccer-p1"), Settings(("FOO",)))
    with pytest.raises(UsageError, match="exclude each other"):
        solve(*own("soccer-p1"), Settings(("ADD", "ADDR")))
    with pytest.raises(UsageError, match="at least one flaw order"):
        Settings(flaw_orders=())
    for weight in (float("nan"), 1e101):
        with pytest.raises(UsageError, match="weight"):
            Settings(weight=weight)
    with pytest.raises(UsageError, match="tolerance"):
        Settings(tolerance_s=0)
    for name in ("node_limit", "step_limit", "ground_limit"):
        with pytest.raises(UsageError, match=name):
            Settings(**{name: -1})
    with pytest.raises(UsageError, match="limit of flaw orders of at least 0, found -1"):
        Settings(flaw_orders=(FlawOrder("LCFR", -1),))


def test_action_cost_by_duration_prefers_the_quick_way():
    domain, problem = read(
        """(define (domain way) (:requirements :durative-actions) (:predicates (here) (half) (there))
          (:durative-action walk :parameters () :duration (= ?duration 100)
            :condition (at start (here)) :effect (at end (there)))
          (:durative-action mount :parameters () :duration (= ?duration 1)
            :condition (at start (here)) :effect (at end (half)))
          (:durative-action ride :parameters () :duration (= ?duration 2)
            :condition (at start (half)) :effect (at end (there))))""",
        "(define (problem p) (:domain way) (:init (here)) (:goal (there)))",
    )
    steps = {cost: len(solve(domain, problem, Settings(action_cost=cost)).plan.steps) for cost in
             ("unit", "duration", "relative")}  # fmt: skip
    assert steps == {"unit": 1, "duration": 2, "relative": 2}


def test_deepening_finds_plans_as_short_as_best_first():
    for name in ("soccer-typed-p1", "kitchen-s2", "kitchen-reach-s1"):
        domain, problem = own(name)
        deep = solve(domain, problem, dataclasses.replace(MATCHING, search="IDA"))
        assert len(deep.plan.steps) == len(solve(domain, problem).plan.steps)
        assert validate(deep.plan, domain, problem) == ""


def test_a_tick_is_what_the_tolerance_says():
    plan = solve(*own("soccer-durative-p1"), dataclasses.replace(MATCHING, tolerance_s=0.1)).plan
    assert plan.steps[0].start == pytest.approx(0.1)
    assert parse_plan(format_links(plan)) == plan
