"""What an action changes: for an executive that keeps count of facts that nobody can observe."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.state import Objects
from tailor.executive.planning.plans.validator import affected


def apply_action(domain: Domain, problem: Problem, facts: frozenset[Fact], action: Fact) -> frozenset[Fact]:
    """The facts after a ground action of the domain, e.g. ("dribbleball", "pos2", "pos3"), with all its effects.

    Its conditions are not asked for: it has been executed, whatever was remembered of the world before.
    """
    name, *arguments = action
    schema = next(schema for schema in domain.actions if schema.name == name)
    binding = {parameter.name: label for parameter, label in zip(schema.parameters, arguments, strict=True)}
    added: set[Fact] = set()
    removed: set[Fact] = set()
    for effect in schema.effects:
        changed = affected(effect, binding, facts, Objects(problem))
        (added if effect.positive else removed).update(changed)
    return (facts - removed) | added
