"""The engine of unified-planning on that library's own test cases, judged by its own validators."""

from __future__ import annotations

import runpy
from fractions import Fraction
from importlib.util import find_spec
from itertools import islice
from pathlib import Path

import pytest

pytest.importorskip("unified_planning", reason="pip install 'tailor[up]' to test the engine")

from unified_planning.engines import CompilationKind, ValidationResultStatus
from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.plans import ActionInstance, PartialOrderPlan, PlanKind, TimeTriggeredPlan
from unified_planning.shortcuts import (
    And,
    AnytimePlanner,
    BoolType,
    Compiler,
    Div,
    DurativeAction,
    EndTiming,
    Fluent,
    InstantaneousAction,
    Int,
    MinimizeActionCosts,
    Not,
    OneshotPlanner,
    Or,
    PlanValidator,
    Problem,
    RealType,
    get_environment,
)
from unified_planning.test.examples import get_example_problems

from tailor.schemas.errors import UsageError
from tailor.tools.up_engine import register
from tailor.tools.up_engine.supported import supported_kind

register()
get_environment().credits_stream = None
SLOW = "matchcellar_static_duration"  # three matches and fuses with durations: minutes of partial-order search
# PDDL 2.1 forbids moving targets: a truck drives off at the very moment of loading, and a fact that the condition of an
# effect reads is deleted at that moment
STRICTER = ("logistic", "temporal_conditional")
THEIRS = Path(find_spec("up_test_cases").submodule_search_locations[0]) / "builtin" / "classical"
ALL = get_example_problems()
for module in ("basic_problems", "metric_problems"):  # read as files: their package imports from the current folder
    given = runpy.run_path(str(THEIRS / f"{module}.py"))["get_test_cases"]()
    ALL |= {f"{module}-{name}": case for name, case in given.items()}
CASES = {name: case for name, case in ALL.items() if case.problem.kind <= supported_kind()}


def their_verdicts(problem, plan):
    """What unified-planning's validators find of a time-triggered plan, or of orders of a partial-order plan."""
    ordered = plan.kind is PlanKind.PARTIAL_ORDER_PLAN
    plans = islice(plan.all_sequential_plans(), 60) if ordered else [plan]
    name = "sequential_plan_validator" if ordered else "up_time_triggered_validator"
    with PlanValidator(name=name) as validator:
        validator.skip_checks = True
        return {validator.validate(problem, each).status for each in plans}


def test_most_cases_without_changing_numbers_are_supported():
    assert len(CASES) >= 32


@pytest.mark.parametrize("name", ["counter", "temporal_counter", "robot_decrease", "travel"])
def test_bounds_of_numbers_do_not_let_numbers_that_change_pass(name):
    problem = ALL[name].problem
    assert problem.kind.has_bounded_types()
    assert not problem.kind <= supported_kind()


@pytest.mark.parametrize("name", ["basic_with_default_values", "robot_fluent_of_user_type"])
def test_object_fluents_are_planned_after_unified_plannings_own_compiler(name):
    problem = ALL[name].problem
    with Compiler(problem_kind=problem.kind, compilation_kind=CompilationKind.USERTYPE_FLUENTS_REMOVING) as compiler:
        compiled = compiler.compile(problem)
    with OneshotPlanner(name="tailor") as planner:
        plan = planner.solve(compiled.problem, timeout=20).plan
    original = plan.replace_action_instances(compiled.map_back_action_instance)
    assert their_verdicts(problem, original) == {ValidationResultStatus.VALID}


@pytest.mark.parametrize("name", [name for name in CASES if name != SLOW])
def test_plans_are_valid_and_statuses_right(name):
    case = CASES[name]
    with OneshotPlanner(name="tailor") as planner:
        result = planner.solve(case.problem, timeout=20)
    if not case.solvable:
        assert result.status is Status.UNSOLVABLE_PROVEN
        assert result.plan is None
        return
    assert result.status is Status.SOLVED_SATISFICING
    assert their_verdicts(case.problem, result.plan) == {ValidationResultStatus.VALID}
    with PlanValidator(name="tailor") as validator:
        assert validator.validate(case.problem, result.plan).status is ValidationResultStatus.VALID


@pytest.mark.parametrize(
    ("name", "plan", "status"),
    [(name, plan, ValidationResultStatus.VALID) for name, case in CASES.items() for plan in case.valid_plans]
    + [(name, plan, ValidationResultStatus.INVALID) for name, case in CASES.items() for plan in case.invalid_plans],
)
def test_verdicts_on_given_plans(name, plan, status):
    with PlanValidator(name="tailor") as validator:
        verdict = validator.validate(CASES[name].problem, plan)
    if name in STRICTER:
        assert "at the same time" in verdict.log_messages[0].message
        status = ValidationResultStatus.INVALID
    assert verdict.status is status


def test_ours_is_the_validator_of_partial_order_plans():
    problem = CASES["robot_loader"].problem
    with OneshotPlanner(name="tailor") as planner:
        plan = planner.solve(problem).plan
    with PlanValidator(problem_kind=problem.kind, plan_kind=PlanKind.PARTIAL_ORDER_PLAN) as validator:
        assert validator.name == "tailor"
        assert validator.validate(problem, plan).status is ValidationResultStatus.VALID
        unordered = PartialOrderPlan({action: [] for action in plan.get_adjacency_list})
        found = validator.validate(problem, unordered)
    assert found.status is ValidationResultStatus.INVALID
    assert "may" in found.log_messages[0].message


def test_anytime_plans_become_cheaper_until_the_cheapest_is_proven():
    problem = two_ways()
    with AnytimePlanner(name="tailor") as planner:
        results = list(planner.get_solutions(problem, timeout=20))
    costs = problem.quality_metrics[0].costs
    totals = [sum(costs[a.action].constant_value() for a in result.plan.get_adjacency_list) for result in results]
    assert totals[-1] == 3
    assert totals == sorted(totals, reverse=True)
    assert [result.status for result in results[:-1]] == [Status.INTERMEDIATE] * (len(results) - 1)
    assert results[-1].status is Status.SOLVED_OPTIMALLY


def two_ways():
    """One step of cost 10, or three of cost 1."""
    problem = Problem("two ways")
    facts = [Fluent(f"f{n}", BoolType()) for n in range(3)]
    for fact in facts:
        problem.add_fluent(fact, default_initial_value=False)
    costs = {}
    for n, fact in enumerate(facts):
        action = InstantaneousAction(f"Walk {n}")  # renamed in PDDL
        if n:
            action.add_precondition(facts[n - 1])
        action.add_effect(fact, True)
        costs[action] = 1
        problem.add_action(action)
    jump = InstantaneousAction("jump")
    jump.add_effect(facts[-1], True)
    problem.add_action(jump)
    problem.add_quality_metric(MinimizeActionCosts({**costs, jump: 10}))
    problem.add_goal(facts[-1])
    return problem


def test_limits_are_timeouts_and_not_proofs():
    with OneshotPlanner(name="tailor") as planner:
        assert planner.solve(CASES[SLOW].problem, timeout=0.2).status is Status.TIMEOUT
    with OneshotPlanner(name="tailor", params={"node_limit": 50, "engine": "pocl"}) as planner:
        assert planner.solve(CASES[SLOW].problem).status is Status.UNSOLVABLE_INCOMPLETELY


def test_an_engine_that_is_not_built_in_is_refused():
    with pytest.raises(UsageError, match="expected auto or pocl or forward, found 'kairos'"):
        OneshotPlanner(name="tailor", params={"engine": "kairos"})


@pytest.mark.parametrize(
    ("params", "complaint"),
    [
        ({"node_limits": 50}, "unknown key 'node_limits'"),
        ({"node_limit": "many"}, "'node_limit' is 'many', expected int"),
        ({"flaw_orders": 3}, "'flaw_orders' is 3, expected a list"),
        ({"flaw_orders": [3]}, "'flaw_orders' is 3, expected a table"),
        ({"rankings": ["SHORTEST"]}, "SHORTEST"),
        ({"memory_mb": "512"}, "memory_mb"),
        ({"weight": -1.0}, "expected a weight"),
        ({"ground": "no"}, "'ground' is 'no', expected bool"),
    ],
)
def test_parameters_are_checked_when_the_engine_is_made(params, complaint):
    with pytest.raises(UsageError, match=complaint):
        OneshotPlanner(name="tailor", params=params)


@pytest.mark.parametrize("orders", ["LCFR", ["LCFR"], ("UCPOP", "LCFR")])
def test_flaw_orders_may_be_texts(orders):
    with OneshotPlanner(name="tailor", params={"flaw_orders": orders, "rankings": "ADDR"}) as planner:
        assert planner.solve(get_example_problems()["basic"].problem).status is Status.SOLVED_SATISFICING


def lasting(duration_s):
    """One action that reaches the goal at its end."""
    problem = Problem("lasting")
    done = problem.add_fluent("done", BoolType(), default_initial_value=False)
    action = DurativeAction("act")
    action.set_fixed_duration(duration_s)
    action.add_effect(EndTiming(), done, True)
    problem.add_action(action)
    problem.add_goal(done)
    return problem


def test_no_schedule_in_whole_ticks_is_no_proof():
    problem = lasting(2)
    key = problem.add_fluent("key", BoolType(), default_initial_value=False)
    problem.action("act").add_condition(EndTiming(), key)
    with OneshotPlanner(name="tailor") as planner:
        assert planner.solve(problem).status is Status.UNSOLVABLE_INCOMPLETELY


def test_the_epsilon_of_the_problem_is_kept():
    problem = CASES["matchcellar"].problem.clone()
    problem.epsilon = 0.5
    with OneshotPlanner(name="tailor") as planner:
        plan = planner.solve(problem, timeout=20).plan
    assert plan.extract_epsilon(problem) >= problem.epsilon


@pytest.mark.parametrize(("epsilon", "duration", "status"), [
    (None, "5", ValidationResultStatus.VALID),
    (None, "5.004", ValidationResultStatus.INVALID),
    (10, "5", ValidationResultStatus.VALID),
    (10, "8", ValidationResultStatus.INVALID),
])  # fmt: skip
def test_durations_of_given_plans_are_exact_whatever_the_epsilon(epsilon, duration, status):
    problem = lasting(5)
    problem.epsilon = epsilon
    action = ActionInstance(problem.action("act"))
    plan = TimeTriggeredPlan([(Fraction(0), action, Fraction(duration))])
    with PlanValidator(name="tailor") as validator:
        assert validator.validate(problem, plan).status is status


def test_goals_that_are_always_true_or_never_have_plans_or_proofs():
    always, never = two_ways(), two_ways()
    fact = always.fluents[0]
    always.add_goal(Or(fact, Not(fact)))
    never.add_goal(And(fact, Not(fact)))
    with OneshotPlanner(name="tailor") as planner:
        found, proven = planner.solve(always), planner.solve(never)
    assert (found.status, proven.status) == (Status.SOLVED_SATISFICING, Status.UNSOLVABLE_PROVEN)
    for problem, verdict in ((always, ValidationResultStatus.VALID), (never, ValidationResultStatus.INVALID)):
        with PlanValidator(name="tailor") as validator:
            assert validator.validate(problem, found.plan).status is verdict
    assert set(their_verdicts(always, found.plan)) == {ValidationResultStatus.VALID}


@pytest.mark.parametrize("seconds", [1e-7, 2000.0])
def test_an_epsilon_that_is_no_tick_is_not_supported(seconds):
    problem = lasting(5)
    problem.epsilon = seconds
    message = f"an epsilon of {seconds:g} s is not supported; expected 1e-06 to 1000 s"
    with OneshotPlanner(name="tailor") as planner, AnytimePlanner(name="tailor") as anytime:
        for result in (planner.solve(problem), *anytime.get_solutions(problem)):
            assert result.status is Status.UNSUPPORTED_PROBLEM
            assert [logged.message for logged in result.log_messages] == [message]
    with OneshotPlanner(name="tailor", params={"tolerance_s": 0.1}) as planner:
        assert planner.solve(problem).plan.timed_actions[0][0] == Fraction("0.1")


def test_a_negative_cost_and_a_strict_limit_of_a_duration_are_not_supported():
    costly, strict = two_ways(), lasting(5)
    costly.quality_metrics[0].costs[costly.action("jump")] = Int(-1)
    strict.action("act").set_open_duration_interval(1, 2)
    for problem, message in ((costly, "a cost below 0"), (strict, "a strict limit of a duration (> ...)")):
        with OneshotPlanner(name="tailor") as planner:
            result = planner.solve(problem)
        assert result.status is Status.UNSUPPORTED_PROBLEM
        assert f"{message} is not supported" in result.log_messages[0].message


@pytest.mark.filterwarnings("ignore:The PDDL printer cannot exactly represent")
@pytest.mark.parametrize("is_parametric", [False, True])
def test_durations_that_pddl_text_rounds_are_exact(is_parametric):
    problem = lasting(Fraction(1, 3))
    if is_parametric:
        length = problem.add_fluent("length", RealType(), default_initial_value=Fraction(2, 3))
        problem.action("act").set_fixed_duration(Div(length(), 2))
    with OneshotPlanner(name="tailor") as planner:
        plan = planner.solve(problem).plan
    assert plan.timed_actions[0][2] == Fraction(1, 3)
    assert their_verdicts(problem, plan) == {ValidationResultStatus.VALID}


@pytest.mark.parametrize(
    ("starts", "status"),
    [((0, 1, 2), ValidationResultStatus.VALID), ((2, 1, 0), ValidationResultStatus.INVALID)],
)
def test_a_time_triggered_plan_of_a_problem_without_time_is_validated_in_its_order(starts, status):
    problem = two_ways()
    steps = [ActionInstance(problem.action(f"Walk {n}")) for n in range(3)]
    plan = TimeTriggeredPlan([(Fraction(start), step, None) for start, step in zip(starts, steps, strict=True)])
    with PlanValidator(name="tailor") as validator:
        assert validator.validate(problem, plan).status is status
    assert their_verdicts(problem, plan) == {status}
