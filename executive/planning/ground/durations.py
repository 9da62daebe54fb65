"""Durations of ground actions, in seconds and ticks."""

from __future__ import annotations

import math
from functools import partial, reduce

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.pddl.language import DurationBound, Function, Number, Numeric, Operation


def evaluate(number: Numeric, binding: Binding, world: StaticWorld) -> float | None:
    """The value in seconds; None if a static function has no value or a divisor is 0."""
    match number:
        case Number(value):
            return value
        case Function(name, terms):
            fact: Fact = (name, *(binding.get(term, term) for term in terms))
            return world.values.get(fact)
        case Operation(operator, operands):
            values = (evaluate(operand, binding, world) for operand in operands)
            return reduce(partial(_operate, operator), values)


def _operate(operator: str, a: float | None, b: float | None) -> float | None:
    if a is None or b is None:
        return None
    match operator:
        case "+":
            return a + b
        case "-":
            return a - b
        case "*":
            return a * b
        case _:
            return a / b if b else None


def duration_range(
    bounds: tuple[DurationBound, ...], binding: Binding, world: StaticWorld
) -> tuple[float, float] | None:
    """Shortest and longest duration in seconds (infinite without an upper limit); None if no duration is allowed."""
    shortest, longest = 0.0, math.inf
    for bound in bounds:
        value = evaluate(bound.value, binding, world)
        if value is None:
            return None
        if bound.operator != "<=":
            shortest = max(shortest, value)
        if bound.operator != ">=":
            longest = min(longest, value)
    return (shortest, longest) if shortest <= longest else None


def ticks_of(bounds: tuple[float, float], tick_s: float) -> tuple[int, int | None]:
    """Shortest and longest duration in ticks, None without an upper limit.

    An action that may take time takes at least one tick, so that start and end differ.
    """
    shortest = round(bounds[0] / tick_s)
    if math.isinf(bounds[1]):
        return max(shortest, 1), None
    longest = round(bounds[1] / tick_s)
    return min(max(shortest, 1), longest), longest
