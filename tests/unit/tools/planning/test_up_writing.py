"""Problems that unified-planning's own PDDL writer refuses or writes wrongly."""

from __future__ import annotations

import pytest

pytest.importorskip("unified_planning", reason="pip install 'tailor[up]' to test the engine")

from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.engines import ValidationResultStatus
from unified_planning.shortcuts import (
    AnytimePlanner,
    BoolType,
    DurativeAction,
    EndTiming,
    Equals,
    Exists,
    Fluent,
    Forall,
    GlobalStartTiming,
    Implies,
    InstantaneousAction,
    IntType,
    MinimizeActionCosts,
    Not,
    OneshotPlanner,
    PlanValidator,
    Problem,
    StartTiming,
    UserType,
    Variable,
    get_environment,
)

from tailor.tools.up_engine import register

register()
get_environment().credits_stream = None


def planned(problem):
    """The result of the engine, its plan validated by unified-planning."""
    with OneshotPlanner(name="tailor") as planner:
        result = planner.solve(problem, timeout=20)
    if result.plan is not None:
        plans = list(result.plan.all_sequential_plans())
        with PlanValidator(name="sequential_plan_validator") as validator:
            assert {validator.validate(problem, each).status for each in plans} == {ValidationResultStatus.VALID}
    return result


def with_goal(predicate="done"):
    """A problem of one fact and two actions, the first of which makes it true."""
    problem = Problem("small")
    problem.add_fluent(predicate, BoolType(), default_initial_value=False)
    problem.add_fluent("other", BoolType(), default_initial_value=False)
    problem.add_goal(problem.fluent(predicate))
    for name, effect in (("act", predicate), ("rest", "other")):
        action = InstantaneousAction(name)
        action.add_effect(problem.fluent(effect), True)
        problem.add_action(action)
    return problem


def test_a_metric_without_the_cost_of_an_action_is_refused_and_breaks_nothing():
    problem = with_goal()
    problem.add_quality_metric(MinimizeActionCosts({problem.action("act"): 3}))
    result = planned(problem)
    assert result.status is Status.UNSUPPORTED_PROBLEM
    assert result.log_messages[0].message == "the metric has no cost of the action rest, and no default"
    problem.clear_quality_metrics()
    problem.add_quality_metric(MinimizeActionCosts({problem.action("act"): 3}, default=1))
    assert planned(problem).status is Status.SOLVED_SATISFICING


def test_costs_may_name_objects_that_no_action_names():
    problem = with_goal()
    thing = problem.add_object("thing", UserType("Thing"))
    price = problem.add_fluent("price", IntType(), default_initial_value=2, thing=UserType("Thing"))
    problem.add_quality_metric(MinimizeActionCosts({problem.action("act"): price(thing)}, default=1))
    with AnytimePlanner(name="tailor") as planner:
        *_, last = planner.get_solutions(problem, timeout=20)
    assert last.status is Status.SOLVED_OPTIMALLY


@pytest.mark.parametrize("name", ["object", "Object"])
def test_a_type_called_object_has_its_own_objects_alone(name):
    kind, other = UserType(name), UserType("truck")
    problem = Problem("types")
    seen = problem.add_fluent("seen", BoolType(), default_initial_value=False, it=kind)
    problem.add_object("box", kind)
    problem.add_object("van", other)
    problem.add_fluent("parked", BoolType(), default_initial_value=False, it=other)
    look = InstantaneousAction("look", it=kind)
    look.add_effect(seen(look.it), True)
    problem.add_action(look)
    it = Variable("it", kind)
    problem.add_goal(Forall(seen(it), it))
    assert [str(action) for action in planned(problem).plan.get_adjacency_list] == ["look(box)"]


@pytest.mark.parametrize("name", ["assign", "preference", "total-cost", "and", "at"])
def test_facts_may_have_any_name(name):
    problem = with_goal(name)
    problem.add_quality_metric(MinimizeActionCosts({}, default=1))
    assert planned(problem).status is Status.SOLVED_SATISFICING


def opening(*, of_all=False, condition=True):
    """A problem in which one or both doors open at 5 s; an action that needs both then reaches the goal."""
    door = UserType("Door")
    problem = Problem("doors")
    is_open = problem.add_fluent("is open", BoolType(), default_initial_value=False, it=door)
    done = problem.add_fluent("done", BoolType(), default_initial_value=False)
    doors = [problem.add_object(f"door {n}", door) for n in range(2)]
    if of_all:
        it = Variable("it", door)
        problem.add_timed_effect(GlobalStartTiming(5), is_open(it), True, condition, forall=[it])
    else:
        problem.set_initial_value(is_open(doors[1]), True)
        problem.add_timed_effect(GlobalStartTiming(5), is_open(doors[0]), True, condition)
    leave = DurativeAction("leave")
    leave.set_fixed_duration(3)
    for each in doors:
        leave.add_condition(StartTiming(), is_open(each))
    leave.add_effect(EndTiming(), done, True)
    problem.add_action(leave)
    problem.add_goal(done)
    return problem


@pytest.mark.parametrize("of_all", [False, True])
def test_timed_effects_may_be_of_all_objects(of_all):
    problem = opening(of_all=of_all)
    with OneshotPlanner(name="tailor") as planner:
        plan = planner.solve(problem, timeout=20).plan
    assert plan.timed_actions[0][0] > 5
    with PlanValidator(name="up_time_triggered_validator") as validator:
        validator.skip_checks = True
        assert validator.validate(problem, plan).status is ValidationResultStatus.VALID


def test_timed_effects_under_a_condition_are_not_supported():
    done = Fluent("done", BoolType())
    with OneshotPlanner(name="tailor") as planner:
        result = planner.solve(opening(condition=done))
    assert result.status is Status.UNSUPPORTED_PROBLEM
    assert result.log_messages[0].message == "a timed effect under a condition is not supported"


@pytest.mark.parametrize("place", ["precondition", "effect", "goal"])
@pytest.mark.parametrize("has_objects", [False, True])
@pytest.mark.parametrize("formula", ["for all", "exists", "not for all", "exists equal", "implies"])
def test_variables_that_a_formula_does_not_have_count_as_well(formula, has_objects, place):
    kind = UserType("thing")
    one, other, problem = Variable("one", kind), Variable("other", kind), with_goal()
    if has_objects:
        problem.add_object("object1", kind)
    idle, act = problem.fluent("other"), problem.action("act")
    condition, without_objects = {
        "for all": (Forall(idle, one), True),
        "exists": (Exists(Not(idle), one), False),
        "not for all": (Not(Forall(idle, one)), False),
        "exists equal": (Exists(Not(idle) & Equals(one, other), one, other), False),
        "implies": (Implies(Exists(Not(idle), one), idle), True),
    }[formula]
    act.clear_effects()
    act.add_effect(problem.fluent("done"), True, condition if place == "effect" else True)
    if place == "precondition":
        act.add_precondition(condition)
    elif place == "goal":
        problem.add_goal(condition)
    problem.action("rest").clear_effects()
    is_possible = without_objects if not has_objects else not without_objects
    assert planned(problem).status is (Status.SOLVED_SATISFICING if is_possible else Status.UNSOLVABLE_PROVEN)
    assert get_environment().simplifier.simplify(Forall(idle, one)) == idle(), "theirs again"
