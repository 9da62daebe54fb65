"""Effects of actions on states, and of an executed one for an executive that tracks facts without sensors."""

from __future__ import annotations

import math

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Domain, Effect, fact_of
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.semantics.large_formulas import holding
from tailor.executive.planning.semantics.state import Binding, Objects, State

MAX_APPLIED = 10_000  # parts of the effects of an executed action, applied in one tick: some milliseconds


def too_large_to_execute(plan: Plan, domain: Domain, problem: Problem) -> str:
    """Names the first step whose effects `apply_action` cannot evaluate within a tick; "" if there is none."""
    objects = Objects(problem)
    sizes = {action.name: _size(action, objects) for action in domain.actions}
    for step in plan.steps:
        size = sizes[step.action[0]]
        if size > MAX_APPLIED:
            return (
                f"step {step.id}: the effects of {format_atom(step.action)} have {size} instances, too many for a tick"
            )
    return ""


def _size(action: Action, objects: Objects) -> int:
    """The number of atoms and connectives in the effects of an action, with all objects for their variables."""
    return sum(
        (1 + sum(parts_of(condition.formula, objects.of, MAX_APPLIED) for condition in effect.condition))
        * math.prod(len(objects.of(variable)) for variable in effect.variables)
        for effect in action.effects
    )


def apply_action(domain: Domain, problem: Problem, facts: frozenset[Fact], action: Fact) -> frozenset[Fact]:
    """The facts after a ground action, with all its effects; its conditions are not checked, as it has been executed.

    Args:
      domain: Domain with the action's schema.
      problem: Problem with the objects.
      facts: Facts before the action.
      action: Name and arguments, e.g. ("dribbleball", "pos2", "pos3"); must be an action of the domain.

    Returns:
      The facts after the action; add effects win over delete effects.
    """
    return state_after(*domain.bound(action), facts, Objects(problem))


def state_after(action: Action, binding: Binding, state: State, objects: Objects) -> State:
    """The state after an action as a whole; add effects win over delete effects."""
    added: set[Fact] = set()
    removed: set[Fact] = set()
    for effect in action.effects:
        (added if effect.positive else removed).update(completed_work(affected(effect, binding, state, objects)))
    return (state - removed) | added


def affected(
    effect: Effect, binding: Binding, state: State, objects: Objects, began: State | None = None
) -> Work[list[Fact]]:
    """The facts that an effect makes true or false in a state.

    Its conditions at start are evaluated in `began`, the state before the action, if given. It has none over all.
    """
    facts: list[Fact] = []
    before = state if began is None else began
    for inner in objects.paced_bindings(effect.variables, binding):
        if inner is None:
            yield
            continue
        for condition in effect.condition:
            then = before if condition.when == "start" else state
            if not (yield from holding(condition.formula, inner, then, objects)):
                break
        else:
            facts.append(fact_of(effect.atom, inner))
    return facts
