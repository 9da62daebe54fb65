"""Why a subgoal was chosen: what the models predict for the other values of one of its free parameters (Figure 11)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings


@dataclass(frozen=True, slots=True)
class Alternatives:
    """Predictions for n values of one variable, all others as chosen. Actions are those within the horizon."""

    variable: int  # id
    values: Array  # (n,) in the variable's unit
    durations_s: Array  # (actions, n) mean
    spread_s: Array  # (actions, n) standard deviation
    failure: Array  # (actions, n) probability
    total_s: Array  # (n,) what was minimised; +inf is INVALID

    @property
    def best(self) -> float:
        """The value with the least total."""
        return float(self.values[int(np.argmin(self.total_s))])

    @property
    def greedy(self) -> float:
        """The value that makes the first action shortest, of those that are valid: what h = 1 would choose."""
        first = np.where(np.isfinite(self.total_s), self.durations_s[0], np.inf)
        return float(self.values[int(np.argmin(first))])


def alternatives(
    sequence: ActionSequence,
    chosen: Mapping[int, float],
    models: Models,
    settings: RefinementSettings,
    variable: int,
    count: int = 73,
) -> Alternatives:
    """Predictions along one free variable, end to end of its range.

    Args:
      sequence: As it was refined.
      chosen: Values of the free variables by id.
      variable: Id of a free variable that occurs within the horizon.

    Raises:
      KeyError: The variable is not free within the horizon.
    """
    objective = SequenceObjective(sequence.within(settings.horizon), sequence.variables, models, settings)
    places = {identifier: place for place, identifier in enumerate(objective.ids)}
    place = places[variable]
    candidates = np.tile(objective.vector(chosen), (count, 1))
    candidates[:, place] = np.linspace(objective.ranges.lower[place], objective.ranges.upper[place], count)
    said = [stage.predict(candidates[:, stage.columns]) for stage in objective.stages]
    return Alternatives(
        variable,
        candidates[:, place],
        np.array([prediction.duration_s for prediction in said]),
        np.array([prediction.spread_s for prediction in said]),
        np.array([prediction.failure for prediction in said]),
        objective(candidates),
    )
