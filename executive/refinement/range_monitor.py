"""Monitors the ranges of the running action's free parameters: whether the belief has moved one off its choice.

An action that ends at a choice out of range does not achieve what the plan needs, and is executed once more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tailor.executive.interfaces.action import Parameter
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.instantiation import Pattern
from tailor.executive.refinement.objective.sequence import ActionSequence, Variable

# Share of a range by which a choice may be outside of it, where the parameter has no tolerance: a wide range states
# that the exact value does not matter much, and believed ranges move a little all the time.
OUTSIDE_SHARE = 0.1


class RangeMonitor:
    """Ranges of the first action of one sequence; later actions are decided anew before they start.

    Args:
      pattern: Pattern of the plan that the sequence comes from.
      sequence: The sequence as decided, asserted subgoals included.
    """

    def __init__(self, pattern: Pattern, sequence: ActionSequence) -> None:
        self._pattern = pattern
        self._choices = tuple(_choices(pattern, sequence))

    def left_by(self, chosen: Mapping[int, float], belief: Belief) -> bool:
        """Whether a chosen value is outside of the range that the belief of now gives, by more than its tolerance.

        Args:
          chosen: Values of the sequence's free variables, by id.
          belief: The belief of now.

        Raises:
          Conflict: The plan cannot be instantiated from this belief.
        """
        return any(
            outside(chosen[one.own], self._pattern.variable(one.in_pattern, belief), one.parameter)
            for one in self._choices
            if one.own in chosen
        )


def outside(value: float, variable: Variable, parameter: Parameter) -> bool:
    """Whether a value is farther from a variable's range than is tolerated; a bound variable has no range."""
    if not variable.free:
        return False
    width = variable.upper - variable.lower
    off = math.remainder(value - 0.5 * (variable.lower + variable.upper), parameter.period)
    tolerance = OUTSIDE_SHARE * width if parameter.tolerance is None else parameter.tolerance
    return abs(off) - 0.5 * width > tolerance


@dataclass(frozen=True, slots=True)
class _Choice:
    """A parameter whose value is chosen: its variable in the sequence and in the pattern."""

    own: int
    in_pattern: int
    parameter: Parameter


def _choices(pattern: Pattern, sequence: ActionSequence) -> Iterator[_Choice]:
    """The free parameters of the first action, if it is in the plan."""
    for parameter, own, in_pattern in pattern.planned(sequence.actions[0]):
        if sequence.variables[own].free:
            yield _Choice(own, in_pattern, parameter)
