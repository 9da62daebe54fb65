"""unified-planning's rules on time: actions overlap themselves only if a problem allows it; time may be discrete."""

from __future__ import annotations

from fractions import Fraction

import pytest

pytest.importorskip("unified_planning", reason="pip install 'tailor[up]' to test the engine")

from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.engines import ValidationResultStatus
from unified_planning.plans import ActionInstance, TimeTriggeredPlan
from unified_planning.shortcuts import (
    FALSE,
    AnytimePlanner,
    BoolType,
    DurativeAction,
    EndTiming,
    GlobalStartTiming,
    InstantaneousAction,
    MinimizeMakespan,
    Not,
    OneshotPlanner,
    PlanValidator,
    Problem,
    StartTiming,
    get_environment,
)

from tailor.tools.up_engine import register

register()
get_environment().credits_stream = None


def lighting(duration_s=5):
    """An action of some seconds whose effect at its start is used up twice."""
    problem = Problem("lighting")
    light = problem.add_fluent("light", BoolType(), default_initial_value=False)
    action = DurativeAction("burn")
    action.set_fixed_duration(duration_s)
    action.add_effect(StartTiming(), light, True)
    problem.add_action(action)
    for n in range(2):
        read = problem.add_fluent(f"read {n}", BoolType(), default_initial_value=False)
        use = InstantaneousAction(f"use {n}")
        use.add_precondition(light)
        use.add_effect(light, False)
        use.add_effect(read, True)
        problem.add_action(use)
        problem.add_goal(read)
    problem.add_quality_metric(MinimizeMakespan())
    return problem


def plans(problem):
    """The plans of both kinds of search, all of them valid."""
    with OneshotPlanner(name="tailor") as once, AnytimePlanner(name="tailor") as anytime:
        found = [once.solve(problem).plan, *(result.plan for result in anytime.get_solutions(problem, timeout=20))]
    for plan in found:
        for name in ("tailor", "up_time_triggered_validator"):
            with PlanValidator(name=name) as validator:
                validator.skip_checks = True
                assert validator.validate(problem, plan).status is ValidationResultStatus.VALID
    return found


def between(plan):
    """Time from the start of the first to that of the second burning."""
    starts = sorted(start for start, instance, _ in plan.timed_actions if instance.action.name == "burn")
    assert len(starts) == 2
    return starts[1] - starts[0]


def test_actions_do_not_overlap_themselves_unless_the_problem_allows_it():
    problem = lighting()
    assert all(between(plan) >= 5 for plan in plans(problem))
    problem.self_overlapping = True
    assert all(between(plan) < 5 for plan in plans(problem))


@pytest.mark.parametrize(("second", "valid"), [(Fraction("5.1"), True), (Fraction("5.05"), False)])
def test_a_plan_whose_action_overlaps_itself_is_invalid(second, valid):
    problem = lighting()
    burn, *uses = (ActionInstance(action) for action in problem.actions)
    again = ActionInstance(problem.action("burn"))
    steps = [(Fraction("0.1"), burn, Fraction(5)), (Fraction(1), uses[0], None), (second, again, Fraction(5))]
    plan = TimeTriggeredPlan([*steps, (Fraction(6), uses[1], None)])
    with PlanValidator(name="tailor") as validator:
        verdict = validator.validate(problem, plan)
        assert (verdict.status is ValidationResultStatus.VALID) is valid
        assert [logged.message for logged in verdict.log_messages] == ([] if valid else ["burn overlaps itself"])
        problem.self_overlapping = True
        assert validator.validate(problem, plan).status is ValidationResultStatus.VALID


def test_times_are_whole_numbers_in_discrete_time():
    problem = lighting()
    problem.discrete_time = True
    for plan in plans(problem):
        assert all(time == int(time) for start, _, duration in plan.timed_actions for time in (start, duration or 0))


def test_a_plan_with_fractions_is_invalid_in_discrete_time():
    problem = lighting()
    problem.self_overlapping = True
    plan = plans(problem)[0]
    problem.discrete_time = True
    with PlanValidator(name="tailor") as validator:
        verdict = validator.validate(problem, plan)
    assert verdict.status is ValidationResultStatus.INVALID
    assert "no whole numbers" in verdict.log_messages[0].message


def test_durations_that_are_no_whole_numbers_have_no_plan_in_discrete_time():
    problem = lighting(Fraction("2.5"))
    problem.discrete_time = True
    with OneshotPlanner(name="tailor") as once, AnytimePlanner(name="tailor") as anytime:
        results = [once.solve(problem), *anytime.get_solutions(problem, timeout=20)]
    assert [result.status for result in results] == [Status.UNSOLVABLE_INCOMPLETELY] * 2
    assert {result.log_messages[0].message for result in results} == {
        "no plan in whole numbers, as discrete time requires"
    }
    assert [result.plan for result in results] == [None, None]


def test_what_begins_at_the_very_end_of_the_same_action_does_not_overlap_it():
    problem = Problem("twice")
    done = problem.add_fluent("done", BoolType(), default_initial_value=False)
    action = DurativeAction("act")
    action.set_fixed_duration(Fraction("0.2"))
    action.add_effect(EndTiming(), done, True)
    problem.add_action(action)
    problem.add_goal(done)
    steps = [(Fraction(n, 10), ActionInstance(action), Fraction("0.2")) for n in (1, 3, 5)]
    with PlanValidator(name="tailor") as validator:
        verdict = validator.validate(problem, TimeTriggeredPlan(steps))
    assert verdict.status is ValidationResultStatus.VALID


@pytest.mark.parametrize("is_durative", [True, False])
def test_plans_have_times_even_where_nothing_that_takes_time_is_possible(is_durative):
    problem = Problem("instant")
    done = problem.add_fluent("done", BoolType(), default_initial_value=False)
    ready = problem.add_fluent("ready", BoolType(), default_initial_value=False)
    for needed, made in ((Not(ready), ready), (ready, done)):
        action = InstantaneousAction(f"make {made.name}")
        action.add_precondition(needed)
        action.add_effect(made, True)
        problem.add_action(action)
    if is_durative:
        never = DurativeAction("never")
        never.add_condition(StartTiming(), FALSE())
        never.add_effect(EndTiming(), done, True)
        problem.add_action(never)
    else:
        problem.add_timed_effect(GlobalStartTiming(0), done, False)
    problem.add_goal(done)
    assert {type(plan) for plan in plans(problem)} == {TimeTriggeredPlan}


def two_bells():
    """Two actions that end by making the same fact true."""
    problem = Problem("two bells")
    rung = problem.add_fluent("rung", BoolType(), default_initial_value=False)
    for n in range(2):
        done = problem.add_fluent(f"done {n}", BoolType(), default_initial_value=False)
        ring = DurativeAction(f"ring {n}")
        ring.set_fixed_duration(2)
        ring.add_effect(EndTiming(), rung, True)
        ring.add_effect(EndTiming(), done, True)
        problem.add_action(ring)
        problem.add_goal(done)
    problem.add_goal(rung)
    return problem


def test_no_two_actions_change_the_same_fact_at_the_same_time():
    assert all(len(plan.timed_actions) == 2 for plan in plans(two_bells()))


@pytest.mark.parametrize(("second", "valid"), [(Fraction(1), True), (Fraction(0), False)])
def test_a_plan_in_which_two_actions_do_is_invalid(second, valid):
    problem = two_bells()
    first, other = map(ActionInstance, problem.actions)
    plan = TimeTriggeredPlan([(Fraction(0), first, Fraction(2)), (second, other, Fraction(2))])
    for name in ("tailor", "up_time_triggered_validator"):
        with PlanValidator(name=name) as validator:
            validator.skip_checks = True
            assert (validator.validate(problem, plan).status is ValidationResultStatus.VALID) is valid
