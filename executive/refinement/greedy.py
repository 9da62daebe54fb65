"""The greedy answer: each action optimised alone, in order (the paper's baseline, horizon 1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Solver


def greedy(
    sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator
) -> GreedySearch:
    """A finished search, with `settings.greedy_checks` batches for each action."""
    search = GreedySearch(sequence, models, settings, rng)
    search.complete(settings.greedy_checks)
    return search


class GreedySearch:
    """Optimises the next action (with its asserted subgoals) alone, then the one after it given that, and so on.

    Resumable; `values`, by variable id, are those of the actions that are done. The free parameters of an action
    without a valid candidate are set to the middle of their ranges.

    Args:
      sequence: Instantiated, with asserted subgoals.
      models: Loaded models.
      settings: Horizon, objective and solver.
      rng: The only source of randomness.
      start: Values by variable id of an earlier answer, as an initial candidate.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
        start: Mapping[int, float] | None = None,
    ) -> None:
        self.values: dict[int, float] = {}
        self.checks = 0
        self._starts = [*([] if start is None else [start]), *sequence.starts]
        self._sequence = sequence
        self._terms = (models, settings)
        self._rng = rng
        self._units = list(sequence.units()[: settings.horizon])
        self._arrival_ids: frozenset[int] = frozenset()
        self._evaluations = 0  # of the actions that are done
        self._objective: SequenceObjective
        self._solver: Solver | None
        self._begin_action()

    @property
    def finished(self) -> bool:
        """Whether all actions within the horizon are done."""
        return not self._units

    @property
    def evaluations(self) -> int:
        """Number of model inputs predicted so far."""
        return self._evaluations + (0 if self.finished else self._objective.evaluations)

    def advance(self, budget: Budget) -> None:
        """Resume the search until the budget is spent or it is finished."""
        while not self.finished:
            self.advance_action(budget)
            if self._solver is not None and not self._solver.finished:
                return
            self.end_action()

    def complete(self, checks: int) -> None:
        """Finish the search with at most so many batches for each action."""
        while not self.finished:
            self.advance_action(CheckBudget(checks))
            self.end_action()

    def advance_action(self, budget: Budget) -> None:
        """Resume the search of the present action alone."""
        if self._solver is not None:
            before = self._solver.checks
            self._solver.advance(budget)
            self.checks += self._solver.checks - before

    def end_action(self) -> None:
        """Take the best values of the present action, and begin with the one after it."""
        if self._solver is not None:
            chosen = self._objective.vector({}) if self._solver.best is None else self._solver.best
            self.values |= self._objective.values(chosen)
            self._sequence = self._sequence.bind(self.values)
        self._evaluations += self._objective.evaluations
        self._arrival_ids = frozenset(self._units.pop(0)[-1].variables)
        if not self.finished:
            self._begin_action()

    def _begin_action(self) -> None:
        models, settings = self._terms
        sequence = self._sequence
        self._objective = SequenceObjective(self._units[0], sequence.variables, models, settings, self._arrival_ids)
        self._solver = None
        if self._objective.ids:
            self._solver = solver_for(self._objective, settings, self._rng, self._objective.vectors(self._starts))
