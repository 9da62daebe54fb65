"""Subgoal assertion: where an action is predicted to fail, another one is put before it (paper 7, Algorithms 3 and 4).

Works for every action that has a success model and names a detour. Where its subgoal lies is left to refinement.
"""

from __future__ import annotations

import numpy as np

from executive.budget import Budget
from executive.library import Models
from executive.refinement.detour import with_detour
from executive.refinement.objective import SequenceObjective
from executive.refinement.sequence import ActionSequence, Failure
from executive.refinement.settings import RefinementSettings
from executive.refinement.weighing import Weighing, accepting

SAMPLES_PER_CHECK = 256


class Assertion:
    """Goes through the next actions and asserts subgoals where they are needed; resumable.

    Args:
      sequence: The instantiated actions.
      models: The loaded models.
      settings: Horizon, limit of the failure probability, number of samples, depth.
      rng: The only source of randomness.
    """

    def __init__(
        self, sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator
    ) -> None:
        self._sequence = sequence
        self._models = models
        self._settings = settings
        self._rng = rng
        self._position = 0
        self._tried = 0
        self._best_success = 0.0
        self._weighing: Weighing | None = None

    def advance(self, budget: Budget) -> ActionSequence | Failure | None:
        """Go on until the budget is spent (None) or every action in the horizon is predicted to succeed.

        Returns:
          The sequence with its asserted subgoals, or why no detour helps.
        """
        while self._position < len(self._sequence.within(self._settings.horizon)):
            if not self._sequence.actions[self._position].action.success_model:
                self._look_at(self._position + 1)
            elif self._weighing is not None:
                if not self._weighed(self._weighing, budget):
                    return None
            elif budget.spent():
                return None
            elif self._succeeds():
                self._look_at(self._position + 1)
            elif self._exhausted():
                failure = self._assert_subgoal()
                if failure is not None:
                    return failure
        return self._sequence

    def _look_at(self, position: int) -> None:
        """Turn to another action."""
        self._position = position
        self._tried = 0
        self._best_success = 0.0

    def _objective(self) -> SequenceObjective:
        """The current action alone, as a function of its free parameters."""
        actions, at = self._sequence.actions, self._position
        arrived = frozenset(actions[at - 1].variables) if at else frozenset()
        return SequenceObjective(actions[at : at + 1], self._sequence.variables, self._models, self._settings, arrived)

    def _succeeds(self) -> bool:
        """Whether one more batch of values holds one for which success is predicted, with margin."""
        objective = self._objective()
        count = SAMPLES_PER_CHECK if objective.ids else 1
        said = objective.stages[0].predict(objective.ranges.draw(count, self._rng))
        failure = np.where(np.isfinite(said.worst_failure + said.duration_s), said.worst_failure, 1.0)
        self._tried += count
        self._best_success = max(self._best_success, 1 - float(failure.min()))
        return bool(failure.min() <= self._settings.p_fail_max)

    def _exhausted(self) -> bool:
        """Whether enough values have been tried to call it a failure for every one."""
        return not self._objective().ids or self._tried >= self._settings.assertion_samples

    def _assert_subgoal(self) -> Failure | None:
        """Put the detour before the current action and look at the detour first."""
        instance = self._sequence.actions[self._position]
        said = f"{instance.action.name} is predicted to fail (success {self._best_success:.2f} at best)"
        if instance.action.detour not in self._sequence.library:
            return Failure(f"{said} and names no detour")
        if self._depth() >= self._settings.assertion_depth:
            return Failure(f"{said} even after {self._depth()} detours")
        detoured = with_detour(self._sequence, self._position)
        if self._settings.weigh_detours and not self._depth():
            self._weighing = Weighing(self._sequence, detoured, self._position, self._models, self._settings, self._rng)
        else:
            self._sequence = detoured
            self._look_at(self._position)  # now the detour
        return None

    def _weighed(self, weighing: Weighing, budget: Budget) -> bool:
        """Whether it has been decided which way is cheaper; then that way is taken."""
        pays = weighing.advance(budget)
        if pays is None:
            return False
        self._weighing = None
        if pays:
            self._sequence = with_detour(self._sequence, self._position)
            self._look_at(self._position)
        else:
            self._sequence = accepting(self._sequence, self._position, 1.0)
            self._look_at(self._position + 1)
        return True

    def _depth(self) -> int:
        """The detours already asserted for the current action, or for the one that it is a detour to."""
        end = 0
        for unit in self._sequence.units():
            end += len(unit)
            if self._position < end:
                return sum(instance.asserted for instance in unit)
        return 0
