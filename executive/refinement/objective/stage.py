"""One action of a sequence as a function of the free parameters: predicted duration, spread and failure.

INVALID (Algorithm 4) is decided here: too likely to fail, or a model that gives no number.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.models import DurationModel, Models, SuccessModel
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.arrivals import displacements
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.subgoal_risk import Spoiling
from tailor.schemas.errors import UsageError


@dataclass(frozen=True, slots=True)
class Prediction:
    """What the models say of one action for n candidates; every field has shape (n,)."""

    duration_s: Array  # mean over the displaced arrivals
    spread_s: Array  # the model's standard deviation, likewise
    failure: Array  # mean probability of failure, the next action's on the way included
    worst_failure: Array  # the largest over the displaced arrivals
    energy_j: Array


@dataclass(frozen=True, slots=True)
class StageModels:
    """The models of one action; None where the action has none."""

    duration: DurationModel
    success: SuccessModel | None
    energy: DurationModel | None


class Stage:
    """The cost of one action. `columns` are the free parameters that it depends on, by place in the free vector.

    Args:
      instance: The action and its variables.
      variables: The sequence's table of variables.
      places: Place in the free vector by variable id.
      arrived: Variables that the action before ends at: only they are displaced.
      models: The loaded models.
      settings: Weights and limits.
      spoils: The risk that this action, a detour, spoils the next one.
    """

    def __init__(
        self,
        instance: InstantiatedAction,
        variables: tuple[Variable, ...],
        places: Mapping[int, int],
        arrived: frozenset[int],
        models: Models,
        settings: RefinementSettings,
        spoils: Spoiling | None = None,
    ) -> None:
        ids = instance.variables
        self.columns: NDArray[np.intp] = np.array(sorted({places[i] for i in ids if i in places}), dtype=np.intp)
        self.rows = 0  # rows predicted so far
        self.action = instance.action
        self.models = models_of(instance.action, models, settings)
        self._settings = settings
        self._spoils = spoils
        self.p_fail_max = settings.p_fail_max if instance.risk is None else instance.risk
        self._template = np.array([variables[i].value or 0.0 for i in ids])
        self.slots = np.array([j for j, i in enumerate(ids) if i in places], dtype=np.intp)
        self.sources = np.searchsorted(self.columns, [places[i] for i in ids if i in places])
        self._displaced = np.array([j for j, i in enumerate(ids) if i in arrived], dtype=np.intp)
        quantities = [instance.action.parameters[j].quantity for j in self._displaced]
        self._displacements = displacements(quantities, dict(settings.arrival_spread))
        parameters = [instance.action.parameters[j] for j in self._displaced]
        self._within = np.array([k for k, parameter in enumerate(parameters) if not parameter.periodic], dtype=np.intp)
        self._lower = np.array([parameters[k].lower for k in self._within])
        self._upper = np.array([parameters[k].upper for k in self._within])

    @property
    def ways(self) -> int:
        """How many displaced arrivals, the exact one included, the cost is averaged over."""
        return len(self._displacements)

    def predict(self, rows: Array) -> Prediction:
        """What the models say for rows of shape (n, len(columns))."""
        count, ways = len(rows), len(self._displacements)
        parameters = self.parameters(rows)
        arguments = self.action.arguments(parameters)
        self.rows += count * ways
        mean, std = self.models.duration.predict(arguments)
        likely = worst = energy = np.zeros(count)
        if self.models.success is not None:
            failure = 1 - self.models.success.probability(arguments)
            likely, worst = _mean(failure, ways), failure.reshape(ways, count).max(axis=0)
        if self._spoils is not None:
            likely = 1 - (1 - likely) * (1 - _mean(self._spoils(parameters), ways))
        if self.models.energy is not None:
            energy = _mean(self.models.energy.predict(arguments)[0], ways)
        return Prediction(_mean(mean, ways), _mean(std, ways), likely, worst, energy)

    def cost(self, rows: Array) -> Array:
        """Seconds, shape (n,), for rows of shape (n, len(columns)); +inf is INVALID."""
        said, settings = self.predict(rows), self._settings
        cost: Array = said.duration_s + settings.k_std * said.spread_s
        if self.models.success is not None or self._spoils is not None:
            cost += settings.risk_cost_s * said.failure
        if self.models.energy is not None:
            cost += settings.energy_weight * said.energy_j
        valid = np.isfinite(cost) & (said.worst_failure <= self.p_fail_max)
        return np.where(valid, cost, np.inf)

    def parameters(self, rows: Array) -> Array:
        """Action parameters, shape (ways * n, p), all candidates for the first displacement first."""
        count, ways = len(rows), len(self._displacements)
        parameters = np.empty((ways, count, len(self._template)))
        parameters[:] = self._template
        parameters[:, :, self.slots] = rows[:, self.sources]
        if ways > 1:
            exact = parameters[:, :, self._displaced]
            parameters[:, :, self._displaced] = self._bounded(exact + self._displacements[:, None, :], exact)
        return parameters.reshape(ways * count, -1)

    def _bounded(self, displaced: Array, exact: Array) -> Array:
        """Displaced values kept to the parameters' ranges, where models know something; angles go free."""
        place = self._within
        lower = np.minimum(exact[:, :, place], self._lower)
        upper = np.maximum(exact[:, :, place], self._upper)
        displaced[:, :, place] = np.minimum(np.maximum(displaced[:, :, place], lower), upper)
        return displaced


def _mean(values: Array, ways: int) -> Array:
    """Mean over the displaced arrivals, shape (n,), of values (ways * n,): numpy's own takes three times as long."""
    if ways == 1:
        return values
    total: Array = np.add.reduce(values.reshape(ways, -1), axis=0)
    return total / ways


def models_of(action: Action, models: Models, settings: RefinementSettings) -> StageModels:
    """The models that an action names.

    Raises:
      UsageError: A named model is not loaded.
    """
    energy_path = action.duration_model.rpartition("/")[0] + "/energy" if settings.energy_weight > 0 else ""
    wanted = [(action.duration_model, models.durations), (energy_path, models.durations)]
    for path, loaded in [*wanted, (action.success_model, models.successes)]:
        if path and path not in loaded:
            raise UsageError(f"action {action.name} needs the model {path}; loaded are {sorted(loaded)}")
    return StageModels(
        models.durations[action.duration_model],
        models.successes[action.success_model] if action.success_model else None,
        models.durations[energy_path] if energy_path else None,
    )
