"""Subgoal assertion: inserts a subgoal before an action that is predicted to fail (paper 7, Algorithms 3 and 4).

Works for every action that has a success model and names a subgoal action. Refinement chooses the asserted subgoal.
"""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.action_context import ContextRows
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.asserted_subgoal import with_subgoal
from tailor.executive.refinement.assertion.feasibility_check import FeasibilityCheck
from tailor.executive.refinement.assertion.subgoal_comparison import (
    SubgoalComparison,
    with_accepted_risk,
    with_any_risk,
)
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.objective.settings import RefinementSettings

HOPELESS = 0.9  # predicted probability of failure beyond which no way among objects is taken
RISK_MARGIN = 0.05  # above the least failure probability of the samples; refinement needs more than a single point


class Assertion:
    """Checks the next actions one after another and asserts subgoals before those predicted to fail; resumable.

    Args:
      sequence: The instantiated actions.
      models: Loaded models.
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
        self._feasibility: FeasibilityCheck | None = None
        self._comparison: SubgoalComparison | None = None
        self._last_resort = ""  # why: every way is risky, and the comparison decides which one is taken
        # Before the first subgoal of the current action: sequence, position, least failure probability
        self._without_subgoal = (sequence, 0, 1.0)

    def advance(self, budget: Budget) -> ActionSequence | Failure | None:
        """Resume until the budget is spent (None) or every action in the horizon is predicted to succeed.

        Returns:
          The sequence with its asserted subgoals, or the reason why no subgoal makes it succeed.
        """
        while self._position < len(self._sequence.within(self._settings.horizon)):
            if not self._sequence.actions[self._position].may_fail:
                self._move_to(self._position + 1)
                continue
            decided = self._compare(self._comparison, budget) if self._comparison else self._check_feasibility(budget)
            if isinstance(decided, Failure):
                return decided
            if not decided:
                return None
        return self._sequence

    def _move_to(self, position: int) -> None:
        """Make the action at `position` the current one."""
        self._position = position
        self._feasibility = None

    def _check_feasibility(self, budget: Budget) -> bool | Failure:
        """Search for values with which the current action succeeds, and decide; False: the budget is spent."""
        if self._feasibility is None:
            if not self._depth():
                self._sequence = with_accepted_risk(self._sequence, self._position, self._settings.p_fail_assert)
            self._feasibility = FeasibilityCheck(
                self._sequence, self._position, self._models, self._settings, self._rng
            )
        succeeds = self._feasibility.advance(budget)
        if succeeds is None:
            return False
        if succeeds:
            self._sequence = self._sequence.starting_from(self._feasibility.starts)
            self._move_to(self._position + 1)
            return True
        return self._resolve_failure(self._feasibility.best_failure)

    def _resolve_failure(self, least_failure: float) -> bool | Failure:
        """Assert a subgoal before the current action, accept its least risk, or fail."""
        instance, depth = self._sequence.actions[self._position], self._depth()
        reason = f"{instance.action.name} is predicted to fail (success probability at most {1 - least_failure:.2f})"
        if not self._has_subgoal_action():
            return Failure(f"{reason} and has no subgoal action")
        may_settle = depth and (not instance.asserted or depth >= self._settings.assertion_depth)
        if may_settle and least_failure <= self._settings.p_fail_settle:
            self._accept_least_risk(least_failure + RISK_MARGIN)
            return True
        if depth >= self._settings.assertion_depth:
            return self._resort(f"{reason} even after {depth} asserted subgoals", instance.context)
        if not depth:
            self._without_subgoal = (self._sequence, self._position, least_failure)
        alternative = with_subgoal(self._sequence, self._position)
        if self._settings.compare_subgoals and not depth:
            args = (self._position, self._models, self._settings, self._rng)
            self._comparison = SubgoalComparison(self._sequence, alternative, *args)
        else:
            self._assert_subgoal(alternative)
        return True

    def _resort(self, reason: str, objects: ContextRows) -> bool | Failure:
        """Among objects, whose price is known, the way with the lower expected cost is taken; otherwise fail."""
        if not objects:
            return Failure(reason)
        direct, position, _ = self._without_subgoal
        self._position, self._last_resort = position, reason
        args = (position, self._models, self._settings, self._rng)
        self._comparison = SubgoalComparison(direct, self._sequence, *args)
        return True

    def _take(self, comparison: SubgoalComparison) -> bool | Failure:
        """Take the cheaper way without limits, unless it is hopeless."""
        if comparison.failure > HOPELESS:
            return Failure(self._last_resort)
        self._sequence, self._last_resort = with_any_risk(comparison.cheaper), ""
        self._move_to(self._position + 1)
        return True

    def _accept_least_risk(self, risk: float) -> None:
        """No start keeps the limit: accept the least risk, and drop the subgoal if it does not lower the risk."""
        sequence, position, least_failure = self._without_subgoal
        if least_failure <= risk:
            self._sequence, self._position = sequence, position
        elif self._feasibility is not None:
            self._sequence = self._sequence.starting_from(self._feasibility.starts)
        self._accept_risk(risk)

    def _accept_risk(self, risk: float) -> None:
        """Accept this probability of failure for the current action and move to the next one."""
        self._sequence = with_accepted_risk(self._sequence, self._position, risk)
        self._move_to(self._position + 1)

    def _compare(self, comparison: SubgoalComparison, budget: Budget) -> bool | Failure:
        """Decide between both sequences by expected cost; False: the budget is spent."""
        cheaper = comparison.advance(budget)
        if cheaper is None:
            return False
        self._comparison = None
        if self._last_resort:
            return self._take(comparison)
        if self._needs_more_subgoals(comparison):
            return self._assert_all_subgoals()
        if cheaper:
            self._assert_subgoal(with_subgoal(self._sequence, self._position).starting_from(comparison.starts))
        else:
            self._accept_risk(1.0)
        return True

    def _needs_more_subgoals(self, comparison: SubgoalComparison) -> bool:
        """Whether an action among objects probably fails with one subgoal, too, and more are allowed."""
        among_objects = bool(self._sequence.actions[self._position].context)
        several = self._settings.assertion_depth > 1
        return among_objects and several and comparison.failure > self._settings.p_fail_settle

    def _assert_all_subgoals(self) -> bool | Failure:
        """Compare with as many subgoals as are possible, searched together: alone, each leg may be feasible."""
        action, count = self._sequence.actions[self._position], 0
        while count < self._settings.assertion_depth and self._has_subgoal_action():
            self._sequence, count = with_subgoal(self._sequence, self._position), count + 1
        return self._resort(
            f"{action.action.name} is predicted to fail even after {count} asserted subgoals", action.context
        )

    def _has_subgoal_action(self) -> bool:
        """Whether a subgoal can be asserted before the current action."""
        return self._sequence.actions[self._position].action.subgoal_action in self._sequence.library

    def _assert_subgoal(self, sequence: ActionSequence) -> None:
        """Adopt a sequence with a subgoal, and check the subgoal action first: it is now at the current position."""
        self._sequence = sequence
        self._move_to(self._position)

    def _depth(self) -> int:
        """Number of subgoals already asserted for the current action, or for the action that it leads to."""
        end = 0
        for unit in self._sequence.units():
            end += len(unit)
            if self._position < end:
                return sum(instance.asserted for instance in unit)
        return 0
