"""Rules of unified-planning on time that PDDL has not: actions that do not overlap themselves, whole numbers.

The first holds unless a problem allows overlaps (`self_overlapping`), the second if its time is discrete.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from tailor.executive.planning import Domain
from tailor.executive.planning.pddl.language import Action, Atom, Condition, Effect, Not


def broken_rule(problem: Any, plan: Any) -> str:
    """Why a time-triggered plan breaks a rule; empty if it breaks none."""
    if not is_whole(problem, plan):
        return "time is discrete, and the plan has times that are no whole numbers"
    action = overlap(problem, plan)
    return f"{action} overlaps itself" if action else ""


def overlap(problem: Any, plan: Any) -> str:
    """The action of which two runs in a time-triggered plan overlap; empty if none does, or if that is allowed."""
    if problem.self_overlapping:
        return ""
    ends: dict[Any, Fraction] = {}
    for start, instance, duration in sorted(plan.timed_actions, key=lambda timed: timed[0]):
        action = instance.action, instance.actual_parameters
        if start < ends.get(action, start):
            return str(instance)
        ends[action] = start + (duration or 0)
    return ""


def is_whole(problem: Any, plan: Any) -> bool:
    """Whether all times of a time-triggered plan are whole numbers, as those of a problem in discrete time are."""
    times = (time or 0 for start, _, duration in plan.timed_actions for time in (start, duration))
    return not problem.discrete_time or all(time == int(time) for time in times)


def without_overlap(domain: Domain) -> Domain:
    """The domain with a fact more for every action that takes time, which is false while it runs."""
    guarded = [action for action in domain.actions if action.duration is not None]
    predicates = {**domain.predicates, **{_name(action): action.parameters for action in guarded}}
    actions = tuple(action if action.duration is None else _guarded(action) for action in domain.actions)
    return replace(domain, predicates=predicates, actions=actions)


def _guarded(action: Action) -> Action:
    runs = Atom(_name(action), tuple(parameter.name for parameter in action.parameters))
    effects = (*action.effects, Effect(runs, True, "start"), Effect(runs, False, "end"))
    return replace(action, conditions=(*action.conditions, Condition(Not(runs))), effects=effects)


def _name(action: Action) -> str:
    return f"runs {action.name}"  # no PDDL text has a predicate with a space
