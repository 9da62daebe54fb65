"""Checks a step by itself: its action, arguments, cost, start and duration."""

from __future__ import annotations

from fractions import Fraction

from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Domain, Numeric
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.semantics.durations import allowed_durations, evaluated
from tailor.executive.planning.semantics.state import Binding, Objects

SLACK_TICKS = 0.51  # of a duration: other planners print whole ticks
SLACK_S = 1e-7  # of a float


class Unsound(Exception):
    """The reason why a plan is unsound."""


def bind_step(step: Step, domain: Domain, objects: Objects) -> tuple[Action, Binding]:
    """The action schema and binding of a step.

    Raises:
      Unsound: No such action, other arguments than it takes, or no cost for them.
    """
    name, *arguments = step.action
    action = next((action for action in domain.actions if action.name == name), None)
    if action is None:
        raise Unsound(f"step {step.id}: the domain has no action '{name}'")
    if len(arguments) != len(action.parameters):
        raise Unsound(f"step {step.id}: '{name}' takes {len(action.parameters)} arguments, not {len(arguments)}")
    for parameter, argument in zip(action.parameters, arguments, strict=True):
        if argument not in objects.of(parameter):
            raise Unsound(f"step {step.id}: '{argument}' is no {' or '.join(parameter.types)}")
    binding = {p.name: a for p, a in zip(action.parameters, arguments, strict=True)}
    if action.cost is not None and not _has_cost(action.cost, binding, objects):
        raise Unsound(f"step {step.id}: {format_atom(step.action)} has no cost of at least 0")
    return action, binding


def _has_cost(cost: Numeric, binding: Binding, objects: Objects) -> bool:
    try:
        return evaluated(cost, binding, objects.problem.values) >= 0
    except (KeyError, ZeroDivisionError):
        return False


def check_times(step: Step, action: Action, binding: Binding, objects: Objects, plan: Plan) -> None:
    """Raises Unsound unless a step of the plan may start when it does, and last as long."""
    if plan.durative and not step.start >= 0:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} starts at {step.start} s, before the initial state")
    if action.duration is None:
        return
    if not plan.durative:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} takes time, but the plan has no durations")
    allowed = allowed_durations(action.duration, binding, objects.problem.values)
    if allowed is None:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} has no possible duration")
    slack_s = Fraction(SLACK_TICKS * plan.tick_s + SLACK_S)  # a bound may be too large for a float
    if not allowed[0] - slack_s <= step.duration <= allowed[1] + slack_s:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} cannot last {step.duration} s")
