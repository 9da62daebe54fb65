"""Whether a detour pays: the expected cost of going straight on against that of the way round (beyond the paper).

A hard limit asserts subgoals that are not needed; here a failure has a price, and the cheaper way wins.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for


class SubgoalComparison:
    """A short search on both sides, in turns; resumable.

    Args:
      direct: The sequence as it is.
      detoured: The same with a detour put at `position`.
      position: Place of the action that may fail in `direct`.
      models: The loaded models.
      settings: `risk_cost_s` is the price of a failure, `weighing_checks` the effort on each side.
      rng: The only source of randomness.
    """

    def __init__(
        self,
        direct: ActionSequence,
        asserted: ActionSequence,
        position: int,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        limited = replace(settings, checks_max=settings.weighing_checks)
        arrived = frozenset(direct.actions[position - 1].variables) if position else frozenset()
        stretches = (
            (accepting(direct, position, 1.0), position + 1),
            (accepting(asserted, position + 1, settings.p_fail_settle), position + 2),
        )
        self._solvers = []
        for sequence, end in stretches:
            objective = SequenceObjective(sequence.actions[position:end], sequence.variables, models, limited, arrived)
            self._solvers.append(solver_for(objective, limited, rng, objective.vectors(sequence.starts)))

    def advance(self, budget: Budget) -> bool | None:
        """Whether the detour costs less than the risk; None when the budget was spent before it is clear."""
        direct, subgoal_action = self._solvers
        for solver in self._solvers:
            solver.advance(budget)
        if not (direct.finished and subgoal_action.finished):
            return None
        return subgoal_action.value < direct.value


def accepting(sequence: ActionSequence, position: int, risk: float) -> ActionSequence:
    """The sequence in which the action at `position` may fail with probability `risk`."""
    actions = list(sequence.actions)
    actions[position] = replace(actions[position], risk=risk)
    return replace(sequence, actions=tuple(actions))
