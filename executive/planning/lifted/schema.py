"""Action schemata as lifted planning uses them: conjunctions of literals, and what must be the same or differ."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from executive.planning.durations import duration_range
from executive.planning.ground_action import INSTANT, MOMENTS, Span
from executive.planning.ground_formula import World
from executive.planning.language import Action, And, Atom, Equal, Formula, Not, Typed
from executive.planning.lifted.bindings import Term


class UnsupportedLifted(Exception):
    """A feature that lifted planning does not speak; ground planning does."""


class LiftedLiteral(NamedTuple):
    """A predicate over terms, or its negation; in a schema variables are plain names."""

    predicate: str
    terms: tuple[Term, ...]
    positive: bool = True

    def of_step(self, step: int) -> LiftedLiteral:
        """The literal with the variables of one step."""
        return self._replace(terms=tuple((t, step) if isinstance(t, str) and t[0] == "?" else t for t in self.terms))


Pairs = tuple[tuple[str, str], ...]


class LiftedEffect(NamedTuple):
    """A literal that becomes true at a moment.

    To achieve anything, each pair of one of the alternatives in `apart` must differ: lest the action demands the
    effect already (the no-op rule), or adds again what it deletes.
    """

    literal: LiftedLiteral
    moment: int
    apart: tuple[Pairs, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Schema:
    """An action schema; its parameters are renamed ?v1, ?v2, ... over the whole domain, as VHPOP prints them."""

    name: str
    parameters: tuple[Typed, ...]
    conditions: tuple[tuple[LiftedLiteral, Span], ...]
    equalities: tuple[tuple[str, str, bool], ...]  # left, right, whether they are the same
    effects: tuple[LiftedEffect, ...]
    shortest: int
    longest: int | None
    duration_s: float


def schemata(world: World, tick_s: float) -> tuple[Schema, ...]:
    """The domain's schemata by name.

    Raises:
      UnsupportedLifted: Disjunctions, quantifiers, conditional effects, durations that depend on arguments.
    """
    count = 0
    made = []
    for action in world.domain.actions:
        names = {p.name: f"?v{count + n}" for n, p in enumerate(action.parameters, 1)}
        count += len(names)
        made.append(_schema(action, names, world, tick_s))
    return tuple(sorted(made, key=lambda schema: schema.name))


def _schema(action: Action, names: dict[str, str], world: World, tick_s: float) -> Schema:
    where = f"action '{action.name}'"
    conditions, equalities = [], []
    for condition in action.conditions:
        span = MOMENTS[condition.when] if world.domain.durative else INSTANT
        for part in conjuncts(condition.formula, where):
            if isinstance(part, LiftedLiteral):
                conditions.append((_renamed(part, names), span))
            else:
                left, right, same = part
                equalities.append((names.get(left, left), names.get(right, right), same))
    bounds = _bounds(action, world, where)
    shortest, longest = bounds
    return Schema(
        action.name,
        tuple(Typed(names[p.name], p.types) for p in action.parameters),
        tuple(conditions),
        tuple(equalities),
        _effects(action, names, tuple(conditions), world.domain.durative, where),
        round(shortest / tick_s),
        None if math.isinf(longest) else round(longest / tick_s),
        shortest,
    )


def _bounds(action: Action, world: World, where: str) -> tuple[float, float]:
    if action.duration is None:
        return 0.0, 0.0
    bounds = duration_range(action.duration, {}, world)
    if bounds is None:
        raise UnsupportedLifted(f"{where}: a duration that depends on arguments")
    return bounds


def conjuncts(formula: Formula, where: str) -> Iterator[LiftedLiteral | tuple[str, str, bool]]:
    """The literals and (in)equalities of a conjunction, in order."""
    match formula:
        case And(parts):
            for part in parts:
                yield from conjuncts(part, where)
        case Atom(predicate, terms):
            yield LiftedLiteral(predicate, terms)
        case Not(Atom(predicate, terms)):
            yield LiftedLiteral(predicate, terms, False)
        case Equal(left, right):
            yield left, right, True
        case Not(Equal(left, right)):
            yield left, right, False
        case _:
            raise UnsupportedLifted(f"{where}: a condition that is no conjunction of literals")


def _renamed(literal: LiftedLiteral, names: dict[str, str]) -> LiftedLiteral:
    return literal._replace(terms=tuple(names.get(t, t) if isinstance(t, str) else t for t in literal.terms))


def _effects(
    action: Action,
    names: dict[str, str],
    conditions: tuple[tuple[LiftedLiteral, Span], ...],
    durative: bool,
    where: str,
) -> tuple[LiftedEffect, ...]:
    made = []
    for effect in action.effects:
        if effect.condition or effect.variables:
            raise UnsupportedLifted(f"{where}: a conditional or quantified effect")
        literal = LiftedLiteral(effect.atom.predicate, effect.atom.terms, effect.positive)
        made.append((_renamed(literal, names), (MOMENTS[effect.when] if durative else INSTANT)[0]))
    effects = []
    for literal, moment in made:
        demanded = _no_op(literal, moment, conditions)
        restored = _unless_added(literal, [other for other, when in made if when == moment])
        if demanded is not None and restored:
            effects.append(LiftedEffect(literal, moment, tuple(demanded + pairs for pairs in restored)))
    return tuple(effects)


def _no_op(literal: LiftedLiteral, moment: int, conditions: tuple[tuple[LiftedLiteral, Span], ...]) -> Pairs | None:
    """The pairs that must differ lest the effect be demanded already; None when it always is."""
    apart: list[tuple[str, str]] = []
    for condition, span in conditions:
        if condition[0] == literal[0] and condition.positive == literal.positive and span[1] == moment:
            differing = _differing(literal, condition)
            if not differing:
                return None
            apart += differing if len(differing) == 1 else ()  # with more, no single pair need differ
    return tuple(apart)


def _unless_added(literal: LiftedLiteral, effects: list[LiftedLiteral]) -> list[Pairs]:
    """The ways in which a delete effect escapes the add effects of its moment, which win; one way for an add effect."""
    ways: list[Pairs] = [()]
    for other in effects:
        if other.positive and not literal.positive and other.predicate == literal.predicate:
            ways = [(*way, pair) for way in ways for pair in _differing(literal, other)]
    return ways


def _differing(a: LiftedLiteral, b: LiftedLiteral) -> Pairs:
    """The pairs of terms that are not the same name; schema terms are plain names."""
    return tuple((str(x), str(y)) for x, y in zip(a.terms, b.terms, strict=True) if x != y)
