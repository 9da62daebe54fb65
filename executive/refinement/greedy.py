"""The greedy answer: each action optimised for itself alone, in order (the paper's baseline, h = 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for


@dataclass(frozen=True, slots=True)
class Greedy:
    """Values by variable id for all actions in the horizon, and the action-model rows that they took."""

    values: dict[int, float]
    rows: int


def greedy(sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator) -> Greedy:
    """Optimise the next action (with its detours) alone, then the one after it given that, and so on.

    It spends `settings.greedy_checks` batches on each action. Where an action has no valid candidate its free
    parameters stay in the middle of their ranges.
    """
    values: dict[int, float] = {}
    rows = 0
    arrived: frozenset[int] = frozenset()
    for unit in sequence.units()[: settings.horizon]:
        objective = SequenceObjective(unit, sequence.variables, models, settings, arrived)
        if objective.ids:
            solver = solver_for(objective, settings, rng, objective.vectors(sequence.starts))
            solver.advance(CheckBudget(settings.greedy_checks))
            chosen = objective.vector({}) if solver.best is None else solver.best
            values |= objective.values(chosen)
            sequence = sequence.bind(values)
        rows += objective.rows
        arrived = frozenset(unit[-1].variables)
    return Greedy(values, rows)


class LocalSearch:
    """Goes on with the greedy search for the next action, with its detours, until it is finished; resumable.

    Args:
      sequence: The whole sequence.
      begun: The greedy answer so far.
      models: The loaded models.
      settings: Those of refinement.
      rng: The only source of randomness.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        begun: Greedy,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        self._begun = begun
        self._objective = SequenceObjective(sequence.units()[0], sequence.variables, models, settings)
        starts = self._objective.vectors([begun.values, *sequence.starts])
        self._solver = solver_for(self._objective, settings, rng, starts)

    @property
    def values(self) -> dict[int, float]:
        """The greedy choice, by variable id, with the best found for the next action."""
        found = {} if self._solver.best is None else self._objective.values(self._solver.best)
        return self._begun.values | found

    @property
    def finished(self) -> bool:
        """Whether more budget would change nothing."""
        return self._solver.finished

    @property
    def rows(self) -> int:
        """Action-model rows predicted."""
        return self._objective.rows

    @property
    def checks(self) -> int:
        """Batches spent."""
        return self._solver.checks

    def advance(self, budget: Budget) -> None:
        """Search on until the budget is spent or the search is finished."""
        self._solver.advance(budget)
