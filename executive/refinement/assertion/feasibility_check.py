"""Whether an action is predicted to succeed for any value of its free parameters: sampled, and resumable."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings

SAMPLES_PER_CHECK = 256
STARTS = 6  # of the values that succeed are handed on to refinement
NEAR = 0.05  # of the least failure probability


class FeasibilityCheck:
    """Looks at one action of a sequence; `best_failure` is the least probability of failure seen so far.

    The limit is the risk accepted for the action, or else the settings' `p_fail_max`.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        position: int,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        instance = sequence.actions[position]
        self._limit = instance.risk if instance.risk is not None else settings.p_fail_max
        arrived = frozenset(sequence.actions[position - 1].variables) if position else frozenset()
        actions = sequence.actions[position : position + 1]
        self.best_failure = 1.0
        self.starts: list[dict[int, float]] = []  # values by variable id that keep the limit, the surest first
        self._objective = SequenceObjective(actions, sequence.variables, models, settings, arrived)
        self._rng = rng
        self._left = settings.assertion_samples if self._objective.ids else 1

    def advance(self, budget: Budget) -> bool | None:
        """True: some value keeps the failure within the limit. False: none does. None: the budget is spent."""
        while self.best_failure > self._limit:
            if self._left <= 0:
                return False
            if budget.spent():
                return None
            count = min(SAMPLES_PER_CHECK, self._left)
            drawn = self._objective.ranges.draw(count, self._rng)
            said = self._objective.stages[0].predict(drawn)
            failure = np.where(np.isfinite(said.worst_failure + said.duration_s), said.worst_failure, 1.0)
            order = np.argsort(failure, kind="stable")[:STARTS]
            self.best_failure = min(self.best_failure, float(failure.min()))
            self.starts = [self._objective.values(drawn[i]) for i in order if failure[i] <= self.best_failure + NEAR]
            self._left -= count
        return True
