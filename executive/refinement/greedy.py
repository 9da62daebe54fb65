"""The greedy answer: each action optimised alone, in order (the paper's baseline, horizon 1)."""

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
    """Values by variable id for all actions in the horizon, and the number of model inputs predicted for them."""

    values: dict[int, float]
    evaluations: int


def greedy(sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator) -> Greedy:
    """Optimise the next action (with its asserted subgoals) alone, then the one after it given that, and so on.

    Spends `settings.greedy_checks` batches on each action. The free parameters of an action without a valid candidate
    are set to the middle of their ranges.
    """
    values: dict[int, float] = {}
    evaluations = 0
    arrival_ids: frozenset[int] = frozenset()
    for unit in sequence.units()[: settings.horizon]:
        objective = SequenceObjective(unit, sequence.variables, models, settings, arrival_ids)
        if objective.ids:
            solver = solver_for(objective, settings, rng, objective.vectors(sequence.starts))
            solver.advance(CheckBudget(settings.greedy_checks))
            chosen = objective.vector({}) if solver.best is None else solver.best
            values |= objective.values(chosen)
            sequence = sequence.bind(values)
        evaluations += objective.evaluations
        arrival_ids = frozenset(unit[-1].variables)
    return Greedy(values, evaluations)


class LocalSearch:
    """Completes the greedy search for the next action, with its asserted subgoals; resumable.

    Args:
      sequence: The whole sequence.
      greedy: The greedy answer so far.
      models: Loaded models.
      settings: Settings of refinement.
      rng: The only source of randomness.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        greedy: Greedy,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        self._greedy = greedy
        self._objective = SequenceObjective(sequence.units()[0], sequence.variables, models, settings)
        starts = self._objective.vectors([greedy.values, *sequence.starts])
        self._solver = solver_for(self._objective, settings, rng, starts)

    @property
    def values(self) -> dict[int, float]:
        """The greedy choice by variable id, with the best values so far for the next action."""
        best = {} if self._solver.best is None else self._objective.values(self._solver.best)
        return self._greedy.values | best

    @property
    def finished(self) -> bool:
        """Whether a larger budget would change nothing."""
        return self._solver.finished

    @property
    def evaluations(self) -> int:
        """Number of model inputs predicted so far."""
        return self._objective.evaluations

    @property
    def checks(self) -> int:
        """Number of batches so far."""
        return self._solver.checks

    def advance(self, budget: Budget) -> None:
        """Resume the search until the budget is spent or the search is finished."""
        self._solver.advance(budget)
