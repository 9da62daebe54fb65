"""Why a subgoal was chosen: what the models predict for its alternatives, and what greedy would have done (Figure 11).

Made from a recorded `Subgoals` message and the action models alone; nothing is executed again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.alternatives import Alternatives, alternatives
from tailor.executive.refinement.greedy import GreedySearch, greedy
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.viewer.explanations.avoided_failure import AvoidedFailure, avoided_failure
from tailor.tools.viewer.explanations.decided_sequence import Decided
from tailor.tools.viewer.explanations.situation import Situation, situations_of

GREEDY_CHECKS = 500  # of each action; the search ends by itself long before


@dataclass(frozen=True, slots=True)
class FreeParameter:
    """A free parameter: what was chosen, what greedy chooses, and the predictions over its range, the others as chosen.

    `touched` are the places of the actions that depend on it, among those within the horizon.
    """

    variable: Variable
    chosen: float
    greedy: float
    alternatives: Alternatives
    touched: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """A choice against its alternatives. Durations are predicted means; `cost` is the objective, +inf is INVALID."""

    decided: Decided
    actions: tuple[str, ...]  # within the horizon, in order
    chosen_s: tuple[float, ...]
    greedy_s: tuple[float, ...]
    chosen_cost: float
    greedy_cost: float
    parameters: tuple[FreeParameter, ...]  # the free ones
    situations: tuple[Situation, ...] = ()  # one for each action, where its model says what it sees
    chosen_j: tuple[float, ...] = ()  # predicted energies, where energy is weighed
    greedy_j: tuple[float, ...] = ()
    avoided: AvoidedFailure | None = None  # by the asserted subgoals that it begins with, if any


def explain(decided: Decided, rng: np.random.Generator) -> Explanation | None:
    """The explanation of a decision; None when nothing was free to choose. The greedy choice is searched anew."""
    sequence, chosen, objective = decided.sequence, decided.chosen, decided.objective
    models, settings = decided.models, decided.settings
    if not objective.ids:
        return None
    alone = greedy_values(sequence, models, settings, rng)
    picked, lone = both = objective.vectors([chosen, alone])
    predictions = objective.predict(both)
    chosen_s, greedy_s = np.transpose([prediction.duration_s for prediction in predictions]).tolist()
    chosen_j, greedy_j = np.transpose([prediction.energy_j for prediction in predictions]).tolist()
    chosen_cost, greedy_cost = objective.total(predictions).tolist()
    return Explanation(
        decided,
        tuple(a.action.name for a in sequence.within(settings.horizon)),
        tuple(chosen_s),
        tuple(greedy_s),
        chosen_cost,
        greedy_cost,
        _parameters(sequence, objective, picked, lone),
        situations_of(sequence.within(settings.horizon), sequence.bind(chosen), sequence.bind(alone), models),
        tuple(chosen_j) if settings.energy_weight else (),
        tuple(greedy_j) if settings.energy_weight else (),
        avoided_failure(decided),
    )


def greedy_values(
    sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator
) -> dict[int, float]:
    """The greedy choice, searched as far as a run with a horizon of one does.

    Against the executive's hasty first answer, refinement would seem to gain more.
    """
    search = GreedySearch(sequence, models, settings, rng, start=greedy(sequence, models, settings, rng).values)
    search.complete(GREEDY_CHECKS)
    return search.values


def _parameters(
    sequence: ActionSequence, objective: SequenceObjective, picked: Array, lone: Array
) -> tuple[FreeParameter, ...]:
    return tuple(
        FreeParameter(
            sequence.variables[along.variable],
            float(picked[place]),
            float(lone[place]),
            along,
            tuple(i for i, stage in enumerate(objective.stages) if place in stage.columns),
        )
        for place, along in enumerate(alternatives(objective, picked))
    )
