"""The objective of subgoal refinement: the summed cost of the next actions over their free parameters (paper 6.2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import ranges_of
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage import Prediction, Stage
from tailor.executive.refinement.objective.subgoal_risk import spoiling


class SequenceObjective:
    """Seconds that a stretch of actions is predicted to cost, for many candidates in one call an action.

    Args:
      actions: The stretch, in order of execution.
      variables: The sequence's table of variables; those without a value are the free ones.
      models: The loaded models.
      settings: Weights and limits.
      arrived: Variables at which the action before the stretch ends; empty when the stretch starts here and now.
    """

    def __init__(
        self,
        actions: Sequence[InstantiatedAction],
        variables: tuple[Variable, ...],
        models: Models,
        settings: RefinementSettings,
        arrived: frozenset[int] = frozenset(),
    ) -> None:
        used = sorted({i for action in actions for i in action.variables if variables[i].free})
        self.ids = tuple(used)
        self.ranges = ranges_of(variables[i] for i in used)
        places = {identifier: place for place, identifier in enumerate(used)}
        stages = []
        for action, following in zip_longest(actions, actions[1:]):
            shared = arrived & frozenset(action.variables)
            spoils = spoiling(action, following, variables)
            stages.append(Stage(action, variables, places, shared, models, settings, spoils))
            arrived = frozenset(action.variables)
        self.stages = tuple(stages)

    @property
    def rows(self) -> int:
        """Action-model rows predicted so far."""
        return sum(stage.rows for stage in self.stages)

    def __call__(self, candidates: Array) -> Array:
        """Cost in seconds, shape (n,), of candidates of shape (n, d); +inf is INVALID."""
        total = np.zeros(len(candidates))
        for stage in self.stages:
            total += stage.cost(candidates[:, stage.columns])
        return total

    def predict(self, candidate: Array) -> tuple[Prediction, ...]:
        """What the models say of each action for one candidate, shape (d,); fields of shape (1,)."""
        return tuple(stage.predict(candidate[None, stage.columns]) for stage in self.stages)

    def vector(self, values: Mapping[int, float]) -> Array:
        """The free vector, shape (d,), for values by variable id; the middle of the range where one is missing."""
        middle = (self.ranges.lower + self.ranges.upper) / 2
        return np.array([values.get(i, default) for i, default in zip(self.ids, middle, strict=True)])

    def vectors(self, starts: Sequence[Mapping[int, float]]) -> Array:
        """Free vectors, shape (s, d), for several starts."""
        return np.array([self.vector(start) for start in starts]).reshape(len(starts), len(self.ids))

    def values(self, candidate: Array) -> dict[int, float]:
        """Values by variable id for a candidate of shape (d,)."""
        return {identifier: float(value) for identifier, value in zip(self.ids, candidate, strict=True)}
