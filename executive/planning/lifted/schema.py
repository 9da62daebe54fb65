"""Lifted action schemata: conditions over variables, equalities, effects, duration."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from tailor.executive.planning.ground.durations import (
    TimeGrid,
    arithmetic_of,
    duration_range,
    evaluate,
    numeric_steps,
    range_ns,
)
from tailor.executive.planning.ground.ground_action import Span, span_of
from tailor.executive.planning.ground.ground_formula import GroundingLimit, StaticWorld
from tailor.executive.planning.lifted.effects import LiftedEffect, Spanned, lifted_effects
from tailor.executive.planning.lifted.formula import Equality, LiftedFormula
from tailor.executive.planning.lifted.lifter import Lifter, Paced
from tailor.executive.planning.pddl.language import Action, Function, Number, Numeric, Operation, Typed
from tailor.executive.planning.structures.connectives import FALSE, conjuncts
from tailor.executive.planning.structures.random_source import RandomSource


@dataclass(frozen=True, slots=True, eq=False)
class Schema:
    """An action schema; its parameters are renamed ?v1, ?v2, ... over the whole domain, as VHPOP prints them.

    An action whose duration or cost depends on parameters gives one schema per choice of objects for these parameters,
    which are then `fixed`. Durations are in units of the time grid; `longest` is None without an upper limit.
    """

    name: str
    parameters: tuple[Typed, ...]
    variables: tuple[Typed, ...]  # bound by "exists" in its conditions
    conditions: Spanned  # literals and disjunctions
    equalities: tuple[Equality, ...]
    fixed: Mapping[str, str]
    effects: tuple[LiftedEffect, ...]
    shortest: int
    longest: int | None
    duration_s: float  # shortest duration
    cost: float  # by which it increases the total cost


def schemata(world: StaticWorld, grid: TimeGrid, limit: GroundingLimit) -> Paced[tuple[Schema, ...]]:
    """The domain's schemata by name; yields after each portion.

    Raises:
      TooMuchToGround: "forall", or durations and costs that depend on parameters, exceed the limit of formulas.
    """
    parameters = itertools.count(1)
    renamed = [
        (action, {p.name: f"?v{next(parameters)}" for p in action.parameters}) for action in world.domain.actions
    ]
    expanded: list[Schema] = []
    for action, names in renamed:
        limit.subject = f"'{action.name}'"
        expanded += yield from _schemata(action, names, Lifter(world, parameters, limit), world, grid)
    return tuple(sorted(expanded, key=lambda schema: schema.name))


def shuffled(schema: Schema, rng: RandomSource) -> Schema:
    """The same schema with its conditions, hence the open conditions, in random order."""
    conditions = tuple(schema.conditions[n] for n in rng.generator.permutation(len(schema.conditions)))
    return replace(schema, conditions=conditions)


def _schemata(
    action: Action, names: dict[str, str], lifter: Lifter, world: StaticWorld, grid: TimeGrid
) -> Paced[list[Schema]]:
    """The schemata of one action: one per choice of the parameters that its duration and cost depend on."""
    durative = world.temporal
    spanned: list[tuple[LiftedFormula, Span]] = []
    for condition in action.conditions:
        parts: tuple[LiftedFormula, ...] = conjuncts((yield from lifter.lift(condition.formula, names)))
        spanned += [(part, span_of(condition.when, durative)) for part in parts]
    spanned = list(dict.fromkeys(spanned))  # each once, or each would be an open condition
    if any(part == FALSE for part, _ in spanned):
        return []
    conditions = tuple((part, span) for part, span in spanned if not isinstance(part, Equality))
    equalities = tuple(part for part, _ in spanned if isinstance(part, Equality))
    effects = yield from lifted_effects(action, names, conditions, lifter, durative)
    parameters = tuple(Typed(names[p.name], p.types) for p in action.parameters)
    made: list[Schema] = []
    for fixed, bounds, cost in _choices(action, lifter, world):
        if lifter.is_due():
            yield
        duration = grid.duration(range_ns(bounds))
        if duration is None:
            continue  # ground actions fit the grid: this one is never applicable
        made.append(
            Schema(
                action.name,
                parameters,
                tuple(lifter.variables),
                conditions,
                equalities,
                {names[name]: value for name, value in fixed.items()},
                effects,
                *duration,
                float(bounds[0]),
                float(cost),
            )
        )
    return made


def _choices(
    action: Action, lifter: Lifter, world: StaticWorld
) -> Iterator[tuple[Mapping[str, str], tuple[Fraction, Fraction | float], Fraction]]:
    """Choices of the parameters that duration and cost depend on, with shortest and longest duration in s, and cost."""
    zero = Fraction(0)
    if action.duration is None and action.cost is None:
        yield {}, (zero, zero), zero
        return
    relevant = {term for number in arithmetic_of(action) for term in _terms(number)}
    parameters = tuple(p for p in action.parameters if p.name in relevant)
    for fixed in lifter.choices(parameters, {}, 1 + numeric_steps(action)):
        durations = (zero, zero) if action.duration is None else duration_range(action.duration, fixed, world)
        cost = zero if action.cost is None else evaluate(action.cost, fixed, world)
        if durations is not None and cost is not None:
            yield fixed, durations, cost


def _terms(number: Numeric) -> Iterator[str]:
    match number:
        case Number():
            return
        case Function(_, terms):
            yield from terms
        case Operation(_, operands):
            for operand in operands:
                yield from _terms(operand)
