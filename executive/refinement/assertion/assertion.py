"""Subgoal assertion: where an action is predicted to fail, another one is put before it (paper 7, Algorithms 3 and 4).

Works for every action that has a success model and names a detour. Where its subgoal lies is left to refinement.
"""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.assertion.feasibility_check import FeasibilityCheck
from tailor.executive.refinement.assertion.subgoal_comparison import SubgoalComparison, accepting
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.objective.settings import RefinementSettings

SLACK = 0.05  # above the least failure probability that was found; without it refinement had a single point to choose


class Assertion:
    """Goes through the next actions and asserts subgoals where they are needed; resumable.

    Args:
      sequence: The instantiated actions.
      models: The loaded models.
      settings: Horizon, limits of the failure probability, number of samples, depth.
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
        self._examination: FeasibilityCheck | None = None
        self._weighing: SubgoalComparison | None = None
        self._plain = (sequence, 0, 1.0)  # before the first detour to the current action: position, least failure

    def advance(self, budget: Budget) -> ActionSequence | Failure | None:
        """Go on until the budget is spent (None) or every action in the horizon is predicted to succeed.

        Returns:
          The sequence with its asserted subgoals, or why no detour helps.
        """
        while self._position < len(self._sequence.within(self._settings.horizon)):
            if not self._sequence.actions[self._position].action.success_model:
                self._look_at(self._position + 1)
                continue
            decided = self._weigh(self._weighing, budget) if self._weighing else self._examine(budget)
            if isinstance(decided, Failure):
                return decided
            if not decided:
                return None
        return self._sequence

    def _look_at(self, position: int) -> None:
        """Turn to another action."""
        self._position = position
        self._examination = None

    def _examine(self, budget: Budget) -> bool | Failure:
        """Look for values with which the current action succeeds, and act on it; False: the budget is spent."""
        if self._examination is None:
            if not self._depth():
                self._sequence = accepting(self._sequence, self._position, self._settings.p_fail_assert)
            self._examination = FeasibilityCheck(
                self._sequence, self._position, self._models, self._settings, self._rng
            )
        succeeds = self._examination.advance(budget)
        if succeeds is None:
            return False
        if succeeds:
            self._sequence = self._sequence.starting_from(self._examination.starts)
            self._look_at(self._position + 1)
            return True
        return self._predicted_to_fail(self._examination.best_failure)

    def _predicted_to_fail(self, least: float) -> bool | Failure:
        """Assert a subgoal, or settle for what is the best anywhere, or give up."""
        instance, depth = self._sequence.actions[self._position], self._depth()
        said = f"{instance.action.name} is predicted to fail (success {1 - least:.2f} at best)"
        if instance.action.subgoal_action not in self._sequence.library:
            return Failure(f"{said} and names no subgoal")
        if depth and not instance.asserted and least <= self._settings.p_fail_settle:
            self._settle(least + SLACK)
            return True
        if depth >= self._settings.assertion_depth:
            return Failure(f"{said} even after {depth} detours")
        if not depth:
            self._plain = (self._sequence, self._position, least)
        asserted = with_subgoal(self._sequence, self._position)
        if self._settings.compare_subgoals and not depth:
            args = (self._position, self._models, self._settings, self._rng)
            self._weighing = SubgoalComparison(self._sequence, asserted, *args)
        else:
            self._take(asserted)
        return True

    def _settle(self, risk: float) -> None:
        """No start keeps the limit: accept the least risk there is, and without the detour where it buys nothing."""
        plain, position, least = self._plain
        if least <= risk:
            self._sequence, self._position = plain, position
        elif self._examination is not None:
            self._sequence = self._sequence.starting_from(self._examination.starts)
        self._accept(risk)

    def _accept(self, risk: float) -> None:
        """Let the current action fail with this probability and turn to the next one."""
        self._sequence = accepting(self._sequence, self._position, risk)
        self._look_at(self._position + 1)

    def _weigh(self, weighing: SubgoalComparison, budget: Budget) -> bool:
        """Decide which way is cheaper and take it; False: the budget is spent."""
        pays = weighing.advance(budget)
        if pays is None:
            return False
        self._weighing = None
        if pays:
            self._take(with_subgoal(self._sequence, self._position))
        else:
            self._accept(1.0)
        return True

    def _take(self, asserted: ActionSequence) -> None:
        """Go on with a detour, and look at it first: it stands where the current action stood."""
        self._sequence = asserted
        self._look_at(self._position)

    def _depth(self) -> int:
        """The detours already asserted for the current action, or for the one that it is a detour to."""
        end = 0
        for unit in self._sequence.units():
            end += len(unit)
            if self._position < end:
                return sum(instance.asserted for instance in unit)
        return 0
