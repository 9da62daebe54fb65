"""Alternatives to a subgoal: predictions for the other values of one of its free parameters (Figure 11)."""

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
    total_s: Array  # (n,) value of the objective; +inf is INVALID

    @property
    def best(self) -> float:
        """Value with the least total."""
        return float(self.values[int(np.argmin(self.total_s))])

    @property
    def greedy(self) -> float:
        """Value that minimises the first action's duration, of the valid ones: the choice with horizon 1."""
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
    """Predictions along one free variable, over its whole range.

    Args:
      sequence: The refined sequence, its variables still free.
      chosen: Values of the free variables by id.
      models: Loaded models.
      settings: Settings of refinement.
      variable: Id of a free variable that occurs within the horizon.
      count: Number of values, equally spaced from end to end of the range.

    Raises:
      KeyError: The variable is not free within the horizon.
    """
    objective = SequenceObjective(sequence.within(settings.horizon), sequence.variables, models, settings)
    columns = {identifier: column for column, identifier in enumerate(objective.ids)}
    column = columns[variable]
    candidates = np.tile(objective.vector(chosen), (count, 1))
    candidates[:, column] = np.linspace(objective.ranges.lower[column], objective.ranges.upper[column], count)
    predictions = [stage.predict(candidates[:, stage.columns]) for stage in objective.stages]
    return Alternatives(
        variable,
        candidates[:, column],
        np.array([prediction.duration_s for prediction in predictions]),
        objective(candidates),
    )
