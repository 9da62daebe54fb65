"""The greedy answer: each action optimised for itself alone, in order (the paper's baseline, h = 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from executive.budget import CheckBudget
from executive.library import Models
from executive.refinement.objective import SequenceObjective
from executive.refinement.selection import solver_for
from executive.refinement.sequence import ActionSequence
from executive.refinement.settings import RefinementSettings


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
