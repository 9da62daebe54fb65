"""One ground action: its conditions, durations, and effects without those that achieve nothing."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from fractions import Fraction
from typing import TypeAlias, TypeVar

from tailor.executive.planning.ground.durations import MAX_NUMBER, duration_range, evaluate, range_ns
from tailor.executive.planning.ground.goal_grounding import PORTION_PARTS, Portions
from tailor.executive.planning.ground.ground_action import (
    GroundAction,
    GroundEffect,
    Span,
    by_span,
    external_conditions,
    span_of,
)
from tailor.executive.planning.ground.ground_formula import (
    Binding,
    FactTable,
    GroundCondition,
    TooMuchToGround,
    bindings,
    contradictory,
    ground,
    negation,
)
from tailor.executive.planning.pddl.formula_text import format_atom, format_number
from tailor.executive.planning.pddl.language import Action, Condition
from tailor.executive.planning.structures.connectives import FALSE, conjuncts

Conditions: TypeAlias = tuple[tuple[GroundCondition, Span], ...]
C = TypeVar("C")  # a condition, ground or lifted
_ZERO = Fraction(0)
_INSTANT = (_ZERO, _ZERO)
MAX_VARIANTS = 64  # of a delete effect beside add effects: doubled by each add effect with conditions at two moments


class NegativeCost(Exception):
    """An action has a cost below 0; the message names both."""


def instance(
    number: int, schema: Action, binding: Binding, portions: Portions
) -> Generator[None, None, GroundAction | None]:
    """The ground action of a complete binding, its durations in ns; None if never applicable or without effect.

    Yields after each portion; small actions are made at once.

    Raises:
      NegativeCost: Its cost is below 0.
      TooMuchToGround: A limit is exceeded.
    """
    world, facts = portions.world, portions.facts
    portions.begin()
    bounds = _INSTANT if schema.duration is None else duration_range(schema.duration, binding, world)
    conditions = yield from _conditions(schema.conditions, binding, portions)
    cost = _ZERO if schema.cost is None else evaluate(schema.cost, binding, world)
    if bounds is None or conditions is None or cost is None:
        return None
    name = (schema.name, *(binding[parameter.name] for parameter in schema.parameters))
    if cost < 0:
        amount = format_number(float(cost)) if cost >= -MAX_NUMBER else f"below {-MAX_NUMBER:g}"  # no float may hold it
        raise NegativeCost(f"the cost {amount} of {format_atom(name)}")
    if max(bounds[0], cost) > MAX_NUMBER:
        raise TooMuchToGround(f"the duration or the cost of '{schema.name}' is above {MAX_NUMBER:g}")
    stated = yield from _effects(schema, binding, portions)
    required = {(part, span[1]) for part, span in conditions}
    useful = [effect for effect in stated if (effect.literal, effect.moment) not in required]
    if len(useful) > PORTION_PARTS:
        yield
    effects, restored = _without_restored(useful, stated, facts)
    if not effects:
        return None
    if len(conditions) > PORTION_PARTS:
        yield
    return GroundAction(
        number,
        name,
        conditions,
        external_conditions(conditions, effects),
        effects,
        _bits(effects),
        *((0, 0) if bounds is _INSTANT else range_ns(bounds)),
        float(bounds[0]),
        not any(effect.conditions for effect in effects),
        float(cost),
        restored,
        _bits(effect for effect in stated if (effect.literal, effect.moment) in required),
    )


def _conditions(
    conditions: tuple[Condition, ...], binding: Binding, portions: Portions
) -> Generator[None, None, Conditions | None]:
    """The ground conditions with their spans, in order; None if one is false or two of one span contradict."""
    grounded: list[tuple[GroundCondition, Span]] = []
    for condition in conditions:
        if portions.is_small(condition.formula):  # without a generator: nearly all are
            result = ground(condition.formula, binding, portions.world, portions.facts)
        else:
            result = yield from portions.ground(condition.formula, binding, True)
        if result == FALSE:
            return None
        for part in conjuncts(result):
            grounded.append((part, span_of(condition.when, portions.world.temporal)))
    spans = {span for _, span in grounded}
    if any(contradictory(part for part, own in grounded if own == span) for span in spans):
        return None
    return tuple(grounded)


def _effects(schema: Action, binding: Binding, portions: Portions) -> Generator[None, None, list[GroundEffect]]:
    world, facts = portions.world, portions.facts
    effects: dict[GroundEffect, None] = {}
    for effect in schema.effects:
        moment = span_of(effect.when, world.temporal)[0]
        facts.limit.depth += bool(effect.variables)
        for inner in bindings(effect.variables, binding, world):
            if effect.variables and portions.is_due():
                yield
            conditions: Conditions | None = ()
            if effect.condition:
                conditions = yield from _conditions(effect.condition, inner, portions)
            if conditions is not None:
                literal = ground(effect.atom, inner, world, facts, effect.positive)
                assert isinstance(literal, int)  # the predicate of an effect is not static
                effects.setdefault(GroundEffect(literal, moment, conditions))
        facts.limit.depth -= bool(effect.variables)
    return list(effects)


def _bits(effects: Iterable[GroundEffect]) -> dict[int, int]:
    """The bit mask of moments by literal."""
    bits: dict[int, int] = {}
    for effect in effects:
        bits[effect.literal] = bits.get(effect.literal, 0) | 1 << effect.moment
    return bits


def _without_restored(
    effects: list[GroundEffect], stated: list[GroundEffect], facts: FactTable
) -> tuple[tuple[GroundEffect, ...], tuple[GroundEffect, ...]]:
    """The effects without those that the action undoes at once, and the latter.

    A delete effect whose literal the same action adds at that moment neither achieves nor threatens: add effects win,
    also those (in `stated`) that achieve nothing because a condition of the action holds up to that very moment.
    """
    deleted = {(effect.literal ^ 1, effect.moment) for effect in effects if effect.literal % 2}
    failures: dict[tuple[int, int], list[list[Conditions]]] = {}
    for effect in stated:
        if (effect.literal, effect.moment) in deleted:
            failures.setdefault((effect.literal, effect.moment), []).append(_failures(effect))
    kept: list[GroundEffect] = []
    restored: list[GroundEffect] = []
    for effect in effects:
        additions = failures.get((effect.literal ^ 1, effect.moment))
        if additions is None:  # nearly all
            kept.append(effect)
            continue
        facts.spend(max(len(additions) - 1, 0))  # each excludes one more condition
        variants = excluding(effect.conditions, additions)
        kept += [effect._replace(conditions=variant) for variant in variants]
        restored += [] if variants else [effect]
    return tuple(kept), tuple(restored)


def _failures(addition: GroundEffect) -> list[Conditions]:
    """Each way in which an add effect does not happen; empty if it always happens.

    One with conditions at several moments fails if those of one moment fail: one way for each.
    """
    failures = [(negation(own), span) for span, own in by_span(addition.conditions).items()]
    return [tuple((part, span) for part in conjuncts(fails)) for fails, span in failures if fails != FALSE]


def excluding(conditions: tuple[C, ...], additions: Iterable[Sequence[tuple[C, ...]]]) -> list[tuple[C, ...]]:
    """Alternative conditions of a delete effect, so that no add effect undoes it; empty if one always happens.

    Nearly all add effects have one way to fail: those of a delete effect beside thousands must not be copied for each.

    Args:
      conditions: Of the delete effect itself.
      additions: The ways in which each add effect of that literal and moment does not happen.

    Raises:
      TooMuchToGround: There are more alternatives than `MAX_VARIANTS`.
    """
    variants = [list(conditions)]
    for ways in additions:
        if len(ways) == 1:
            for variant in variants:
                variant.extend(ways[0])
        else:
            variants = [[*variant, *way] for variant in variants for way in ways]
        if len(variants) > MAX_VARIANTS:
            raise TooMuchToGround(f"more than {MAX_VARIANTS} variants of a delete effect of one action")
    return [tuple(variant) for variant in variants]
