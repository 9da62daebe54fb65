"""Watches the believed values that a running sequence is bound to: whether the world has moved them away.

Asked in every tick, so only those values are looked up that have a tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.instantiation import ActionSequence, Failure, Pattern


class BeliefMonitor:
    """The values of one sequence, and how far each may move before the sequence has to be thought over.

    Args:
      pattern: Of the plan that the sequence comes from.
      sequence: As it was decided on, detours included.
    """

    def __init__(self, pattern: Pattern, sequence: ActionSequence) -> None:
        self._pattern = pattern
        self._bounds = tuple(dict.fromkeys(_bounds(pattern, sequence)))

    def moved(self, belief: Belief) -> bool:
        """Whether a value is believed to be elsewhere by more than its tolerance, and the plan still makes sense."""
        try:
            if not any(self._is_off(*bound, belief) for bound in self._bounds):
                return False
        except Conflict:
            return False
        return not isinstance(self._pattern.sequence(belief), Failure)

    def _is_off(self, identifier: int, then: float, tolerance: float, belief: Belief) -> bool:
        now = self._pattern.value(identifier, belief)
        return now is not None and abs(then - now) > tolerance


def _bounds(pattern: Pattern, sequence: ActionSequence) -> Iterator[tuple[int, float, float]]:
    """Variable of the pattern, value then, and tolerance, for each watched parameter of the sequence."""
    planned = {(action.step, action.action.name): action for action in pattern.actions}
    for action in sequence.actions:
        same = planned.get((action.step, action.action.name))
        if same is None:
            continue  # a detour: the plan does not know it
        for parameter, then, now in zip(action.action.parameters, action.variables, same.variables, strict=True):
            value = sequence.variables[then].value
            if parameter.tolerance is not None and value is not None:
                yield now, value, parameter.tolerance
