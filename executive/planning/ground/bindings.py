"""Exhaustive grounding of a schema: every choice of objects for its parameters that the static conditions allow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import prod

from tailor.executive.planning.ground.ground_formula import Binding, FactTable, StaticWorld, ground
from tailor.executive.planning.pddl.language import Action, And, Atom, Condition, Equal, Formula, Not
from tailor.executive.planning.structures.connectives import FALSE


def schema_bindings(schema: Action, world: StaticWorld) -> Iterator[Binding | None]:
    """Complete bindings that satisfy the static conditions; None for each partial binding that was tried."""
    names = [parameter.name for parameter in schema.parameters]
    tests: list[list[Formula]] = [[] for _ in range(len(names) + 1)]
    for part in conjuncts_of(schema.conditions):
        if is_static(part, world):
            level = max((names.index(term) + 1 for term in terms_of(part) if term in names), default=0)
            tests[level].append(part)
    choices = [world.choices(parameter) for parameter in schema.parameters]
    yield from _extend({}, 0, names, choices, tests, world)


def least_bindings(schema: Action, world: StaticWorld) -> int:
    """Least number of bindings that `schema_bindings` tries: all without static conditions, else the empty one."""
    if any(is_static(part, world) for part in conjuncts_of(schema.conditions)):
        return 1
    return max(1, prod(len(world.choices(parameter)) for parameter in schema.parameters))


def _extend(
    binding: Binding,
    level: int,
    names: list[str],
    choices: list[tuple[str, ...]],
    tests: list[list[Formula]],
    world: StaticWorld,
) -> Iterator[Binding | None]:
    if tests[level] and _fails(tests[level], binding, world):
        yield None
    elif level == len(names):
        yield binding
    else:
        yield None
        for name in choices[level]:
            yield from _extend({**binding, names[level]: name}, level + 1, names, choices, tests, world)


def _fails(tests: list[Formula], binding: Binding, world: StaticWorld) -> bool:
    nothing = FactTable()
    return any(ground(test, binding, world, nothing) == FALSE for test in tests)


def conjuncts_of(conditions: tuple[Condition, ...]) -> Iterator[Formula]:
    """The conjuncts of the conditions of all moments, the last first."""
    pending = [condition.formula for condition in conditions]
    while pending:
        formula = pending.pop()
        if isinstance(formula, And):
            pending += formula.parts
        else:
            yield formula


def is_static(formula: Formula, world: StaticWorld) -> bool:
    """Whether a conjunct is an equality or a static atom, or the negation of one."""
    inner = formula.part if isinstance(formula, Not) else formula
    return isinstance(inner, Equal) or (isinstance(inner, Atom) and inner.predicate in world.static)


def without_static(schema: Action, world: StaticWorld) -> Action:
    """The schema without the static conjuncts of its conditions, for bindings that satisfy them."""
    kept = tuple(replace(part, formula=_fluent(part.formula, world)) for part in schema.conditions)
    return replace(schema, conditions=kept)


def _fluent(formula: Formula, world: StaticWorld) -> Formula:
    if isinstance(formula, And):
        return And(tuple(_fluent(part, world) for part in formula.parts if not is_static(part, world)))
    return And(()) if is_static(formula, world) else formula


def terms_of(formula: Formula) -> tuple[str, ...]:
    """The terms of a literal or equality."""
    match formula:
        case Not(part):
            return terms_of(part)
        case Equal(left, right):
            return (left, right)
        case Atom(_, terms):
            return terms
        case _:
            return ()
