"""Durations of ground actions: exact in nanoseconds, then in whole units of a time grid that fits all of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial, reduce
from itertools import pairwise

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.pddl.language import (
    Action,
    DurationBound,
    Function,
    Number,
    Numeric,
    Operation,
    numbers_in,
)
from tailor.executive.planning.pddl.times import NS_PER_S, exact, nanoseconds

Range = tuple[int, int | None]  # shortest and longest duration, None without an upper limit
MAX_NUMBER = 10**9  # seconds, and the cost of an action: as numbers in PDDL text; plans stay below UNBOUNDED
FREE_NUMBERS = 3  # of a duration and a cost, as many as the domains at hand have


@dataclass(frozen=True, slots=True)
class TimeGrid:
    """The unit in which times are whole numbers, and the least time between dependent events.

    With durations that are multiples of the tolerance the unit is the tolerance and the separation 1. `widest_ns` is
    the separation without times that cut it; 0: this one is.
    """

    unit_ns: int
    separation: int = 1
    widest_ns: int = field(default=0, compare=False)

    @property
    def unit_s(self) -> float:
        """The unit in seconds."""
        return self.unit_ns / NS_PER_S

    def seconds(self, units: float) -> float:
        """The nearest float to so many units in seconds."""
        return int(units) * self.unit_ns / NS_PER_S

    def fits(self, times_s: Iterable[float]) -> bool:
        """Whether times are multiples of the unit, and lead to this separation: no earlier ones have cut it."""
        times_ns, separation_ns = [nanoseconds(time_s) for time_s in times_s], self.separation * self.unit_ns
        widest_ns = self.widest_ns or separation_ns
        on_grid = all(time_ns % self.unit_ns == 0 for time_ns in times_ns)
        return on_grid and min([widest_ns, *_gaps(times_ns)]) == separation_ns

    def units(self, time_s: float) -> int:
        """The nearest multiple of the unit to a time."""
        return round(Fraction(nanoseconds(time_s), self.unit_ns))

    def duration(self, range_ns: Range) -> Range | None:
        """A duration in units; an action that may take time takes at least the separation. None if none fits."""
        shortest = -(-range_ns[0] // self.unit_ns)
        if range_ns[1] is None:
            return max(shortest, self.separation), None
        longest = range_ns[1] // self.unit_ns
        return (min(max(shortest, self.separation), longest), longest) if shortest <= longest else None


def time_grid(tolerance_s: float, ranges_ns: Iterable[Range], times_s: Iterable[float]) -> TimeGrid:
    """The coarsest grid that holds the tolerance, all durations and the given times.

    The separation is the tolerance, or the shortest action or least time between two given times (and the start) where
    that is shorter.
    """
    tolerance_ns, times_ns = max(nanoseconds(tolerance_s), 1), [nanoseconds(time_s) for time_s in times_s]
    ends = {time_ns for bounds in ranges_ns for time_ns in bounds if time_ns}
    longest = [bounds[1] for bounds in ranges_ns if bounds[1]]
    widest_ns = min([tolerance_ns, *longest])
    unit_ns = math.gcd(tolerance_ns, *ends, *times_ns)
    return TimeGrid(unit_ns, min([widest_ns, *_gaps(times_ns)]) // unit_ns, widest_ns)


def _gaps(times_ns: Iterable[int]) -> Iterator[int]:
    """The differences between the start and the given times, those of equal times left out."""
    return (later - earlier for earlier, later in pairwise(sorted({0, *times_ns})))


def evaluate(number: Numeric, binding: Binding, world: StaticWorld) -> Fraction | None:
    """The value in seconds; None if a static function has no value or a divisor is 0."""
    match number:
        case Number(value):
            return exact(value)
        case Function(name, terms):
            fact: Fact = (name, *(binding.get(term, term) for term in terms))
            own = world.values.get(fact)
            return None if own is None else exact(own)
        case Operation(operator, operands):
            values = (evaluate(operand, binding, world) for operand in operands)
            return reduce(partial(_operate, operator), values)


def _operate(operator: str, a: Fraction | None, b: Fraction | None) -> Fraction | None:
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


def arithmetic_of(action: Action) -> list[Numeric]:
    """The expressions in an action's duration and cost."""
    return [*(bound.value for bound in action.duration or ()), *([] if action.cost is None else [action.cost])]


def numeric_steps(action: Action) -> int:
    """Steps of grounding that the arithmetic of an action's duration and cost takes for one binding; 0 if it is short.

    A number takes as long as two formulas.
    """
    return 2 * max(sum(map(numbers_in, arithmetic_of(action))) - FREE_NUMBERS, 0)


def duration_range(
    bounds: tuple[DurationBound, ...], binding: Binding, world: StaticWorld
) -> tuple[Fraction, Fraction | float] | None:
    """Shortest and longest duration in seconds (infinite without an upper limit); None if no duration is allowed."""
    shortest = Fraction(0)
    longest: Fraction | float = math.inf
    for bound in bounds:
        value = evaluate(bound.value, binding, world)
        if value is None:
            return None
        if bound.operator != "<=":
            shortest = max(shortest, value)
        if bound.operator != ">=":
            longest = value if value < longest else longest
    return (shortest, longest) if shortest <= longest else None


def range_ns(bounds: tuple[Fraction, Fraction | float]) -> Range:
    """The durations in whole nanoseconds within the bounds; where there is none, the nearest.

    Without an upper limit if that is above MAX_NUMBER seconds.
    """
    shortest = math.ceil(bounds[0] * NS_PER_S)
    if not isinstance(bounds[1], Fraction) or bounds[1] > MAX_NUMBER:
        return shortest, None
    longest = math.floor(bounds[1] * NS_PER_S)
    if shortest > longest:
        shortest = longest = round(bounds[0] * NS_PER_S)
    return shortest, longest
