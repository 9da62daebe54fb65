"""Effects of actions on states, and of an executed one for an executive that tracks facts without sensors."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Domain, Effect
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.semantics.large_formulas import holding
from tailor.executive.planning.semantics.state import Binding, Objects, State, fact_of


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
    name, *arguments = action
    schema = next(schema for schema in domain.actions if schema.name == name)
    binding = {parameter.name: label for parameter, label in zip(schema.parameters, arguments, strict=True)}
    added: set[Fact] = set()
    removed: set[Fact] = set()
    for effect in schema.effects:
        changed = completed_work(affected(effect, binding, facts, Objects(problem)))
        (added if effect.positive else removed).update(changed)
    return (facts - removed) | added


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
