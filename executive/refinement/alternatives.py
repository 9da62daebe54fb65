"""Alternatives to a subgoal: predictions for the other values of each of its free parameters (Figure 11)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective


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


def alternatives(objective: SequenceObjective, chosen: Array, count: int = 73) -> tuple[Alternatives, ...]:
    """Predictions along each free variable, over its whole range.

    An action's models are run once, for the variables that it depends on.

    Args:
      objective: Of the refined sequence, its d variables still free.
      chosen: Their values, shape (d,), in the order of `objective.ids`.
      count: Number of values of each, equally spaced from end to end of its range.
    """
    free = len(chosen)
    candidates = np.tile(chosen, (free, count, 1))
    for column, (lower, upper) in enumerate(zip(objective.ranges.lower, objective.ranges.upper, strict=True)):
        candidates[column, :, column] = np.linspace(lower, upper, count)
    durations_s = np.empty((free, len(objective.stages), count))
    total_s = np.zeros((free, count))
    for index, stage in enumerate(objective.stages):
        varied = candidates[stage.columns].reshape(len(stage.columns) * count, free)
        prediction = stage.predict(np.vstack([chosen, varied])[:, stage.columns])
        durations_s[:, index] = _along(stage.columns, prediction.duration_s, total_s.shape)
        total_s += _along(stage.columns, stage.cost_of(prediction), total_s.shape)
    values = candidates[range(free), :, range(free)]
    return tuple(map(Alternatives, objective.ids, values, durations_s, total_s))


def _along(columns: NDArray[np.intp], predicted: Array, shape: tuple[int, int]) -> Array:
    """Predictions for all free variables, shape (d, n), from those for the chosen values and along `columns`."""
    spread = np.full(shape, predicted[0])
    spread[columns] = predicted[1:].reshape(len(columns), shape[1])
    return spread
