"""Rules of relaxed reachability: if all atoms of a body are reached, so are the atoms of the head.

An action is one rule, whose choices of objects are the reachable ground actions; each conditional or quantified effect
is one more. Only static and positive conjuncts are read: all other conditions are taken for reached.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

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
    is_quantified: bool = False  # whether some may be those of an effect


def rules_of(action: Action, world: StaticWorld) -> Iterator[Rule]:
    """The rule of an action, those of its conditional and quantified effects, then those of its start alone."""
    own = {effect.atom.predicate for effect in action.effects if effect.positive and effect.when == "start"}
    literals = tuple(_usable(action.conditions, own if action.duration is not None else set(), world))
    added = [effect for effect in action.effects if effect.positive]
    plain = tuple(effect.atom for effect in added if not effect.condition and not effect.variables)
    yield _rule(action, action.parameters, literals, plain, True)
    for effect in added:
        if effect.condition or effect.variables:
            more = tuple(_usable(effect.condition, own, world))
            yield _rule(action, action.parameters + effect.variables, literals + more, (effect.atom,), False)
    if own and action.duration is not None:
        yield from _start_rules(action, literals, own, world)


def _start_rules(action: Action, literals: tuple[Formula, ...], own: set[str], world: StaticWorld) -> Iterator[Rule]:
    """Rules of what a start makes true: that may serve an action which the later conditions wait for."""
    at_start = tuple(condition for condition in action.conditions if condition.when == "start")
    usable = tuple(_usable(at_start, own, world))
    if all(part in usable or is_static(part, world) for part in literals):
        return  # it has no later conditions that other actions achieve
    for effect in action.effects:
        if effect.positive and effect.when == "start":
            more = tuple(_usable(effect.condition, own, world))
            rule = _rule(action, action.parameters + effect.variables, usable + more, (effect.atom,), False)
            yield replace(rule, is_quantified=bool(effect.variables))


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
    tests = tuple(part for part in parts if not isinstance(part, Atom))
    return Rule(action.name, variables, body, tests, head, whole, is_quantified=not whole)
