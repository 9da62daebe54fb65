"""Grounding: action schemas x objects -> ground actions, pruned early by static facts and inequalities.

Owns the order that every count depends on: actions by name, objects by name (constants first), parameters from left
to right.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.planning.ground.durations import duration_range, ticks_of
from tailor.executive.planning.ground.ground_action import (
    INSTANT,
    MOMENTS,
    GroundAction,
    GroundEffect,
    Span,
    external_conditions,
)
from tailor.executive.planning.ground.ground_formula import (
    Binding,
    FactTable,
    GroundCondition,
    StaticWorld,
    TooMuchToGround,
    bindings,
    contradictory,
    ground,
    negation,
)
from tailor.executive.planning.pddl.language import Action, And, Atom, Condition, Equal, Formula, Not, When
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.structures.connectives import FALSE, conjunction, conjuncts

MAX_ACTIONS = 10_000  # of a ground task; the competition problems at hand have 756 at most
MAX_VARIANTS = 64  # of a delete effect beside add effects: doubled by each add effect with conditions at two moments
CHECK_EVERY = 64  # bindings tried per unit of budget: about a tenth of a millisecond


@dataclass(frozen=True, slots=True)
class GroundActions:
    """The ground actions of a static world and the facts they mention, by number; reusable with an equal world."""

    world: StaticWorld
    tick_s: float
    facts: tuple[tuple[str, ...], ...]
    actions: tuple[GroundAction, ...]


def static_world(problem: Problem) -> StaticWorld:
    """The part of a problem that no action changes."""
    domain = problem.domain
    changing = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    changing |= {timed.literal.fact[0] for timed in problem.timed}
    static = frozenset(set(domain.predicates) - changing)
    ordered = sorted(domain.constants, key=lambda t: t.name) + sorted(problem.objects, key=lambda t: t.name)
    objects: dict[str, list[str]] = {kind: [] for kind in domain.types}
    for item in ordered:
        for kind in frozenset[str]().union(*(domain.ancestors[own] for own in item.types)):
            objects[kind].append(item.name)
    facts = frozenset(fact for fact in problem.initial if fact[0] in static)
    by_type = {kind: tuple(names) for kind, names in objects.items()}
    return StaticWorld(domain, by_type, static, facts, dict(problem.values), domain.durative)


def ground_actions(world: StaticWorld, tick_s: float, limit: int) -> Iterator[GroundActions | None]:
    """Grounds all actions: yields None every CHECK_EVERY bindings, and the ground actions at the end.

    Raises:
      TooMuchToGround: More than `limit` bindings of parameters tried, or too many formulas or actions.
    """
    facts = FactTable()
    actions: list[GroundAction] = []
    tried = 0
    for schema in sorted(world.domain.actions, key=lambda action: action.name):
        for binding in _schema_bindings(schema, world):
            tried += 1
            if tried > limit:
                raise TooMuchToGround(f"grounding tried more than {limit} bindings, the last of '{schema.name}'")
            if tried % CHECK_EVERY == 0:
                yield None
            if binding is not None:
                action = _instance(len(actions), schema, binding, world, facts, tick_s)
                actions += [action] if action else []
                if len(actions) > MAX_ACTIONS:
                    raise TooMuchToGround(f"more than {MAX_ACTIONS} ground actions")
    yield GroundActions(world, tick_s, tuple(facts), tuple(actions))


def shuffled(grounded: GroundActions, rng: np.random.Generator) -> GroundActions:
    """The same ground actions with their conditions, hence the open conditions, in random order."""
    mixed = (
        tuple(action.conditions[n] for n in rng.permutation(len(action.conditions))) for action in grounded.actions
    )
    actions = (replace(action, conditions=own) for action, own in zip(grounded.actions, mixed, strict=True))
    return replace(grounded, actions=tuple(actions))


# --- bindings ------------------------------------------------------------------------------------
def _schema_bindings(schema: Action, world: StaticWorld) -> Iterator[Binding | None]:
    """Complete bindings that satisfy the static conditions; None for each partial binding that was tried."""
    names = [parameter.name for parameter in schema.parameters]
    tests: list[list[Formula]] = [[] for _ in range(len(names) + 1)]
    for part in _static_parts(schema, world):
        level = max((names.index(term) + 1 for term in _terms(part) if term in names), default=0)
        tests[level].append(part)
    choices = [world.choices(parameter) for parameter in schema.parameters]
    yield from _extend({}, 0, names, choices, tests, world)


def _extend(
    binding: Binding,
    level: int,
    names: list[str],
    choices: list[tuple[str, ...]],
    tests: list[list[Formula]],
    world: StaticWorld,
) -> Iterator[Binding | None]:
    nothing = FactTable()
    if any(ground(test, binding, world, nothing) == FALSE for test in tests[level]):
        yield None
    elif level == len(names):
        yield binding
    else:
        yield None
        for name in choices[level]:
            yield from _extend({**binding, names[level]: name}, level + 1, names, choices, tests, world)


def _static_parts(schema: Action, world: StaticWorld) -> Iterator[Formula]:
    """The conjuncts of the conditions that static facts and equality decide."""
    pending = [condition.formula for condition in schema.conditions]
    while pending:
        formula = pending.pop()
        inner = formula.part if isinstance(formula, Not) else formula
        if isinstance(formula, And):
            pending += formula.parts
        elif isinstance(inner, Equal) or (isinstance(inner, Atom) and inner.predicate in world.static):
            yield formula


def _terms(formula: Formula) -> tuple[str, ...]:
    match formula:
        case Not(part):
            return _terms(part)
        case Equal(left, right):
            return (left, right)
        case Atom(_, terms):
            return terms
        case _:
            return ()


# --- one ground action ---------------------------------------------------------------------------
def _instance(
    number: int, schema: Action, binding: Binding, world: StaticWorld, facts: FactTable, tick_s: float
) -> GroundAction | None:
    """The ground action; None if it is never applicable or achieves nothing."""
    bounds = duration_range(schema.duration or (), binding, world) if schema.duration is not None else (0.0, 0.0)
    conditions = _conditions(schema.conditions, binding, world, facts)
    if bounds is None or conditions is None:
        return None
    effects = _useful(conditions, _effects(schema, binding, world, facts))
    if not effects:
        return None
    bits: dict[int, int] = {}
    for effect in effects:
        bits[effect.literal] = bits.get(effect.literal, 0) | 1 << effect.moment
    name = (schema.name, *(binding[parameter.name] for parameter in schema.parameters))
    return GroundAction(
        number,
        name,
        conditions,
        external_conditions(conditions, effects),
        effects,
        bits,
        *ticks_of(bounds, tick_s),
        bounds[0],
        not any(effect.conditions for effect in effects),
    )


def _span(when: When, temporal: bool) -> Span:
    return MOMENTS[when] if temporal else INSTANT


def _conditions(
    conditions: tuple[Condition, ...], binding: Binding, world: StaticWorld, facts: FactTable
) -> tuple[tuple[GroundCondition, Span], ...] | None:
    """The ground conditions with their spans, in order; None if one is false or two of one span contradict."""
    grounded: list[tuple[GroundCondition, Span]] = []
    for condition in conditions:
        result = ground(condition.formula, binding, world, facts)
        if result == FALSE:
            return None
        for part in conjuncts(result):
            grounded.append((part, _span(condition.when, world.temporal)))
    spans = {span for _, span in grounded}
    if any(contradictory(part for part, own in grounded if own == span) for span in spans):
        return None
    return tuple(grounded)


def _effects(schema: Action, binding: Binding, world: StaticWorld, facts: FactTable) -> list[GroundEffect]:
    effects: dict[GroundEffect, None] = {}
    for effect in schema.effects:
        moment = _span(effect.when, world.temporal)[0]
        for inner in bindings(effect.variables, binding, world):
            conditions = _conditions(effect.condition, inner, world, facts)
            if conditions is not None:
                literal = ground(effect.atom, inner, world, facts, effect.positive)
                assert isinstance(literal, int)  # the predicate of an effect is not static
                effects.setdefault(GroundEffect(literal, moment, conditions))
    return list(effects)


def _useful(
    conditions: tuple[tuple[GroundCondition, Span], ...], effects: list[GroundEffect]
) -> tuple[GroundEffect, ...]:
    """The effects without no-ops: those that a condition of the action implies, or that the action undoes at once.

    An effect is a no-op if a condition of the action holds up to that very moment. A delete effect whose literal the
    same action adds at that moment neither achieves nor threatens: add effects win.
    """
    required = {(part, span[1]) for part, span in conditions}
    at: dict[tuple[int, int], list[GroundEffect]] = {}
    for effect in effects:
        at.setdefault((effect.literal, effect.moment), []).append(effect)
    kept: list[GroundEffect] = []
    for effect in effects:
        if (effect.literal, effect.moment) not in required:
            additions = at.get((effect.literal ^ 1, effect.moment), []) if effect.literal % 2 else []
            kept += _unless_added(effect, additions)
    return tuple(kept)


def _unless_added(effect: GroundEffect, additions: list[GroundEffect]) -> list[GroundEffect]:
    """An effect under conditions that exclude the add effects of its moment; empty if one of these always happens.

    An add effect with conditions at several moments fails if those of one moment fail: each gives one variant.
    """
    variants = [effect.conditions]
    for other in additions:
        spans: dict[Span, list[GroundCondition]] = {}
        for condition, span in other.conditions:
            spans.setdefault(span, []).append(condition)
        failures = [(negation(conjunction(own)), span) for span, own in spans.items()]
        variants = [
            (*variant, *((part, span) for part in conjuncts(fails)))
            for variant in variants
            for fails, span in failures
            if fails != FALSE
        ]
        if len(variants) > MAX_VARIANTS:
            raise TooMuchToGround(f"more than {MAX_VARIANTS} variants of a delete effect of one action")
    return [effect._replace(conditions=variant) for variant in variants] if additions else [effect]
