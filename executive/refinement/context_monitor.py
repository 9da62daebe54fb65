"""Monitors the objects in whose context a sequence was decided: whether one is new, gone or moved."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.action_context import ActionContext, ContextRows
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.objective.sequence import ActionSequence


class ContextMonitor:
    """Objects of one sequence, with the tolerances of their columns.

    Args:
      sequence: The sequence as decided, asserted subgoals included.
    """

    def __init__(self, sequence: ActionSequence) -> None:
        self._contexts = tuple(
            {
                instance.action.name: (instance.action.context, instance.context)
                for instance in sequence.actions
                if instance.action.context is not None
            }.values()
        )

    def objects_changed(self, belief: Belief) -> bool:
        """Whether the believed objects differ in number, or by more than a tolerance."""
        return any(rows_differ(context, decided, context.believed(belief)) for context, decided in self._contexts)


def rows_differ(context: ActionContext, decided: ContextRows, believed: ContextRows) -> bool:
    """Whether an object of one side has no counterpart within the tolerances on the other side.

    The order of the rows has no effect, since noise may change it.
    """
    if len(decided) != len(believed):
        return True
    if decided == believed:
        return False
    tolerance = np.array([np.inf if c.tolerance is None else c.tolerance for c in context.columns])
    near = (np.abs(np.array(decided)[:, None] - np.array(believed)) <= tolerance).all(axis=2)
    return not (near.any(axis=0).all() and near.any(axis=1).all())
