"""How good a plan is by its problem's metric: makespan, total cost, or number of steps."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Literal as OneOf

from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.semantics.durations import evaluated

Measure = OneOf["makespan", "cost", "steps"]


def measure_of(problem: Problem) -> Measure:
    """What is to be small: the metric, or without one the makespan if actions take time, else the number of steps."""
    if problem.metric:
        return problem.metric
    return "makespan" if problem.domain.durative else "steps"


def quality(plan: Plan, problem: Problem) -> float:
    """The plan's value by that measure; smaller is better."""
    match measure_of(problem):
        case "cost":
            return total_cost(plan, problem)
        case "makespan":
            return plan.makespan
        case _:
            return float(len(plan.steps))


def total_cost(plan: Plan, problem: Problem) -> float:
    """What the plan's steps add to (total-cost).

    Args:
      plan: A sound plan of the problem.
      problem: Its domain and the values of its functions.

    Returns:
      The exact sum as the nearest float (infinite beyond all), without an initial value of (total-cost).
    """
    total = Fraction(0)
    for step in plan.steps:
        action, binding = problem.domain.bound(step.action)
        if action.cost is not None:
            total += evaluated(action.cost, binding, problem.values)
    try:
        return float(total)
    except OverflowError:
        return math.inf
