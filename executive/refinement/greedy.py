"""The greedy answer: each action optimised alone, in order (the paper's baseline, horizon 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
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
