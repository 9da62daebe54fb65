"""Monitors the believed values that a running sequence is bound to, the ranges of its choice, and the objects near it.

Runs in every tick, so it looks up only values with a tolerance, and the ranges of the running action.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.context_monitor import ContextMonitor
from tailor.executive.refinement.instantiation import Pattern
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.range_monitor import RangeMonitor


class BeliefMonitor:
    """Values and ranges of one sequence, each with the tolerance beyond which the executive deliberates again.

    Args:
      pattern: Pattern of the plan that the sequence comes from.
      sequence: The sequence as decided, asserted subgoals included.
    """

    def __init__(self, pattern: Pattern, sequence: ActionSequence) -> None:
        self._pattern = pattern
        self._bindings = tuple(dict.fromkeys(_bindings(pattern, sequence)))
        self._ranges = RangeMonitor(pattern, sequence)
        self._objects = ContextMonitor(sequence)

    def outdated(self, belief: Belief, chosen: Mapping[int, float]) -> bool:
        """Whether a value is beyond its tolerance and the plan can still be instantiated.

        Args:
          belief: The belief of now.
          chosen: Values of the sequence's free variables, by id.
        """
        try:
            moved = any(self._violated(*binding, belief) for binding in self._bindings)
            if not moved and not self._ranges.left_by(chosen, belief):
                return False
        except Conflict:
            return False
        return not isinstance(self._pattern.sequence(belief), Failure)

    def among_changed_objects(self, belief: Belief) -> ActionSequence | None:
        """The plan instantiated anew if an object is new, gone or moved beyond its tolerance; otherwise None."""
        if not self._objects.objects_changed(belief):
            return None
        return self.sequence(belief)

    def sequence(self, belief: Belief) -> ActionSequence | None:
        """The plan instantiated from a belief; None if it does not fit it."""
        sequence = self._pattern.sequence(belief)
        return None if isinstance(sequence, Failure) else sequence

    def of(self, sequence: ActionSequence) -> BeliefMonitor:
        """A monitor of another sequence of the same plan."""
        return BeliefMonitor(self._pattern, sequence)

    def _violated(self, identifier: int, bound: float, tolerance: float, period: float, belief: Belief) -> bool:
        believed = self._pattern.value(identifier, belief)
        return believed is not None and abs(math.remainder(bound - believed, period)) > tolerance


def _bindings(pattern: Pattern, sequence: ActionSequence) -> Iterator[tuple[int, float, float, float]]:
    """Variable of the pattern, bound value, tolerance and period, for each monitored parameter of the sequence."""
    for action in sequence.actions:
        for parameter, own, in_pattern in pattern.planned(action):
            value = sequence.variables[own].value
            if parameter.tolerance is not None and value is not None:
                yield in_pattern, value, parameter.tolerance, parameter.period
