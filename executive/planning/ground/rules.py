"""Rules of relaxed reachability: if all atoms of a body are reached, so are the atoms of the head.

An action is one rule, whose choices of objects are the reachable ground actions; each conditional or quantified effect
is one more. Only static and positive conjuncts are read: all other conditions are taken for reached.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tailor.executive.planning.ground.bindings import conjuncts_of, is_static
from tailor.executive.planning.ground.ground_formula import StaticWorld
from tailor.executive.planning.pddl.language import Action, Atom, Condition, Formula, Typed


@dataclass(frozen=True, slots=True)
class Rule:
    """`body` implies `head` for all objects of the variables' types that pass the tests."""

    action: str
    variables: tuple[Typed, ...]
    body: tuple[Atom, ...]
    tests: tuple[Formula, ...]  # equalities and negated static atoms
    head: tuple[Atom, ...]
    is_action: bool  # whether the variables are the parameters of the action


def rules_of(action: Action, world: StaticWorld) -> Iterator[Rule]:
    """The rule of an action, then those of its conditional and quantified effects."""
    own = {effect.atom.predicate for effect in action.effects if effect.positive and effect.when == "start"}
    literals = tuple(_usable(action.conditions, own if action.duration is not None else set(), world))
    added = [effect for effect in action.effects if effect.positive]
    plain = tuple(effect.atom for effect in added if not effect.condition and not effect.variables)
    yield _rule(action, action.parameters, literals, plain, True)
    for effect in added:
        if effect.condition or effect.variables:
            more = tuple(_usable(effect.condition, own, world))
            yield _rule(action, action.parameters + effect.variables, literals + more, (effect.atom,), False)


def _usable(conditions: tuple[Condition, ...], own: set[str], world: StaticWorld) -> Iterator[Formula]:
    """The conjuncts that a rule reads, in order; not those that the action's own start may make true."""
    for formula in reversed(list(conjuncts_of(tuple(c for c in conditions if c.when == "start")))):
        if isinstance(formula, Atom) or is_static(formula, world):
            yield formula
    for formula in reversed(list(conjuncts_of(tuple(c for c in conditions if c.when != "start")))):
        if is_static(formula, world) or (isinstance(formula, Atom) and formula.predicate not in own):
            yield formula


def _rule(
    action: Action, variables: tuple[Typed, ...], literals: Iterable[Formula], head: tuple[Atom, ...], whole: bool
) -> Rule:
    parts = dict.fromkeys(literals)
    body = tuple(part for part in parts if isinstance(part, Atom))
    return Rule(action.name, variables, body, tuple(p for p in parts if not isinstance(p, Atom)), head, whole)
