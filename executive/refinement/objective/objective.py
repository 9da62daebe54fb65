"""Objective of subgoal refinement: the summed cost of the next actions over their free parameters (paper 6.2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.joint_costs import joint_costs
from tailor.executive.refinement.objective.ranges import ranges_of
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage import Prediction, Stage
from tailor.executive.refinement.objective.subgoal_risk import risk_to_next


class SequenceObjective:
    """Predicted cost of consecutive actions in seconds; evaluates many candidates with one model call for each action.

    Args:
      actions: Consecutive actions in order of execution.
      variables: Variable table of the sequence; d of the variables are free and occur in `actions`.
      models: Loaded models.
      settings: Weights and limits.
      arrival_ids: Variables at which the action before `actions` ends; empty if `actions` start from the belief.

    Raises:
      UsageError: An action names a model that is not loaded.
    """

    def __init__(
        self,
        actions: Sequence[InstantiatedAction],
        variables: tuple[Variable, ...],
        models: Models,
        settings: RefinementSettings,
        arrival_ids: frozenset[int] = frozenset(),
    ) -> None:
        used = sorted({i for action in actions for i in action.variables if variables[i].free})
        self.ids = tuple(used)
        self.ranges = ranges_of(variables[i] for i in used)
        columns = {identifier: column for column, identifier in enumerate(used)}
        stages = []
        for action, following in zip_longest(actions, actions[1:]):
            displaced_ids = arrival_ids & frozenset(action.variables)
            risk = risk_to_next(action, following, variables)
            stages.append(Stage(action, variables, columns, displaced_ids, models, settings, risk))
            arrival_ids = frozenset(action.variables)
        self.stages = tuple(stages)
        self.coarse_stages = tuple(stage.at_exact_arrival() for stage in stages)

    @property
    def evaluations(self) -> int:
        """Number of model inputs predicted so far."""
        return sum(stage.evaluations for stage in (*self.stages, *self.coarse_stages))

    def __call__(self, candidates: Array) -> Array:
        """Cost in seconds, shape (n,), of candidates of shape (n, d); +inf is INVALID."""
        return self.total(self.predict(candidates))

    def total(self, predictions: Sequence[Prediction]) -> Array:
        """Cost in seconds, shape (n,), from what `predict` returns; +inf is INVALID."""
        total = np.zeros(len(predictions[0].duration_s))
        for stage, prediction in zip(self.stages, predictions, strict=True):
            total += stage.cost_of(prediction)
        return total

    def costs(self, stages: Sequence[Stage], samples: Sequence[Array]) -> list[Array]:
        """Cost of several stages, each for samples of its own; those of one model are predicted together."""
        return joint_costs(stages, samples)

    def predict(self, candidates: Array) -> tuple[Prediction, ...]:
        """Predictions for candidates, shape (n, d) or (d,) for one, action by action; fields of shape (n,)."""
        rows = np.atleast_2d(candidates)
        return tuple(stage.predict(rows[:, stage.columns]) for stage in self.stages)

    def vector(self, values: Mapping[int, float]) -> Array:
        """Candidate, shape (d,), from values by variable id; the middle of the range if one is missing."""
        middle = (self.ranges.lower + self.ranges.upper) / 2
        return np.array([values.get(i, default) for i, default in zip(self.ids, middle, strict=True)])

    def vectors(self, starts: Sequence[Mapping[int, float]]) -> Array:
        """Candidates, shape (s, d), from several starts."""
        return np.array([self.vector(start) for start in starts]).reshape(len(starts), len(self.ids))

    def values(self, candidate: Array) -> dict[int, float]:
        """Values by variable id of a candidate, shape (d,)."""
        return {identifier: float(value) for identifier, value in zip(self.ids, candidate, strict=True)}
