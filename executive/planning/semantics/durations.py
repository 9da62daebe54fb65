"""Durations that a problem allows for a step; the validator's own evaluation of PDDL arithmetic, in exact fractions."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from fractions import Fraction

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import DurationBound, Function, Number, Numeric
from tailor.executive.planning.semantics.state import Binding

_OPERATORS: dict[str, Callable[[Fraction, Fraction], Fraction]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


def allowed_durations(
    bounds: tuple[DurationBound, ...], binding: Binding, values: Mapping[Fact, float]
) -> tuple[Fraction, Fraction | float] | None:
    """Shortest and longest duration of a step in seconds.

    Args:
      bounds: Constraints of the action schema on ?duration.
      binding: Objects of the action's parameters.
      values: Values of the problem's static functions.

    Returns:
      The closed interval, up to infinity without an upper bound; None when it is empty, a function has no value or
      a divisor is 0.
    """
    try:
        numbers = [(bound.operator, evaluated(bound.value, binding, values)) for bound in bounds]
    except (KeyError, ZeroDivisionError):
        return None
    shortest = max([Fraction(0), *(value for comparison, value in numbers if comparison != "<=")])
    longest = min([value for comparison, value in numbers if comparison != ">="], default=math.inf)
    return (shortest, longest) if shortest <= longest else None


def evaluated(number: Numeric, binding: Binding, values: Mapping[Fact, float]) -> Fraction:
    """The value of an arithmetic expression over static functions.

    Raises:
      KeyError: A function has no value.
      ZeroDivisionError: A divisor is 0.
    """
    if isinstance(number, Number):
        return Fraction(str(number.value))
    if isinstance(number, Function):
        return Fraction(str(values[(number.name, *(binding.get(term, term) for term in number.terms))]))
    result, *others = (evaluated(operand, binding, values) for operand in number.operands)
    for other in others:
        result = _OPERATORS[number.operator](result, other)
    return result
