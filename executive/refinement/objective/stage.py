"""Cost of one action of a sequence as a function of the free parameters: predicted duration, its std and failure.

INVALID (Algorithm 4) is decided here: failure too probable, or a prediction that is not finite.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.action import Parameter
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.arrivals import displacements
from tailor.executive.refinement.objective.context_success import ContextSuccess
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.executive.refinement.objective.subgoal_risk import RiskToNext


@dataclass(frozen=True, slots=True)
class Prediction:
    """Predictions of the models of one action for n candidates; every field has shape (n,)."""

    duration_s: Array  # mean over the displaced arrivals
    std_s: Array  # standard deviation of the duration model, mean over the displaced arrivals
    failure: Array  # mean probability of failure, including the risk to the next action
    worst_failure: Array  # maximum over the displaced arrivals
    energy_j: Array
    failure_s: Array  # expected price of failures; an object that is met has one of its own


class Stage:
    """Cost of one action. `columns` are the free parameters that it depends on, as columns of a candidate.

    Args:
      instance: The action and its variables.
      variables: Variable table of the sequence.
      columns: Column of a candidate by variable id.
      displaced_ids: Variables at which the action before ends: only these are displaced.
      models: Loaded models.
      settings: Weights and limits.
      risk_to_next: Risk that this action, if it leads to an asserted subgoal, poses to the next one.
    """

    def __init__(
        self,
        instance: InstantiatedAction,
        variables: tuple[Variable, ...],
        columns: Mapping[int, int],
        displaced_ids: frozenset[int],
        models: Models,
        settings: RefinementSettings,
        risk_to_next: RiskToNext | None = None,
    ) -> None:
        ids = instance.variables
        self.columns: NDArray[np.intp] = np.array(sorted({columns[i] for i in ids if i in columns}), dtype=np.intp)
        self.evaluations = 0  # model inputs predicted so far
        self.action = instance.action
        self.models = models_of(instance, models, settings)
        self._settings = settings
        self._risk_to_next = risk_to_next
        self.p_fail_max = settings.p_fail_max if instance.risk is None else instance.risk
        self.context_cost_s = context_cost_s(instance, settings)
        self._template = np.array([variables[i].value or 0.0 for i in ids])
        self.slots = np.array([j for j, i in enumerate(ids) if i in columns], dtype=np.intp)
        self.sources = np.searchsorted(self.columns, [columns[i] for i in ids if i in columns])
        self._displaced = np.array([j for j, i in enumerate(ids) if i in displaced_ids], dtype=np.intp)
        parameters = [instance.action.parameters[j] for j in self._displaced]
        self._displacements = _displacements(parameters, settings)
        self._clipped = np.array([k for k, parameter in enumerate(parameters) if not parameter.periodic], dtype=np.intp)
        self._lower = np.array([parameters[k].lower for k in self._clipped])
        self._upper = np.array([parameters[k].upper for k in self._clipped])

    @property
    def n_arrivals(self) -> int:
        """Number of displaced arrivals, the exact one included, that the cost is averaged over."""
        return len(self._displacements)

    def at_exact_arrival(self) -> Stage:
        """The same cost without displaced arrivals: an approximation with fewer model inputs, counted apart."""
        stage = copy(self)
        stage._displacements = self._displacements[:1]
        stage.evaluations = 0
        return stage

    def predict(self, samples: Array) -> Prediction:
        """Predictions for samples of the free parameters, shape (n, len(columns))."""
        parameters = self.parameters(samples)
        arguments = self.action.arguments(parameters)
        return self.prediction(parameters, arguments, *self.models.duration.predict(arguments))

    def prediction(self, parameters: Array, arguments: Array, mean: Array, std: Array) -> Prediction:
        """Predictions from the outputs of the duration model, both of shape (n_arrivals * n,)."""
        arrivals = len(self._displacements)
        count = len(parameters) // arrivals
        self.evaluations += len(parameters)
        failure = own = worst = energy = met = np.zeros(count)
        success = self.models.success
        if isinstance(success, ContextSuccess):
            alone, in_spite = success.factors(arguments)
            failures = 1 - alone * in_spite
            own, met = _mean(1 - alone, arrivals), _mean(1 - in_spite, arrivals)
        elif success is not None:
            failures = 1 - success.probability(arguments)
            own = _mean(failures, arrivals)
        if success is not None:
            failure, worst = _mean(failures, arrivals), failures.reshape(arrivals, count).max(axis=0)
        if self._risk_to_next is not None:
            risk = _mean(self._risk_to_next(parameters), arrivals)
            failure, own = 1 - (1 - failure) * (1 - risk), 1 - (1 - own) * (1 - risk)
        if self.models.energy is not None:
            energy = _mean(self.models.energy.predict(arguments)[0], arrivals)
        price_s = self._settings.risk_cost_s * own + self.context_cost_s * met
        return Prediction(_mean(mean, arrivals), _mean(std, arrivals), failure, worst, energy, price_s)

    def cost(self, samples: Array) -> Array:
        """Seconds, shape (n,), for samples of shape (n, len(columns)); +inf is INVALID."""
        return self.cost_of(self.predict(samples))

    def cost_of(self, prediction: Prediction) -> Array:
        """As `cost`, from the predictions for the samples."""
        settings = self._settings
        cost: Array = prediction.duration_s + settings.k_std * prediction.std_s
        if self.models.success is not None or self._risk_to_next is not None:
            cost += prediction.failure_s
        if self.models.energy is not None:
            cost += settings.energy_weight * prediction.energy_j
        valid = np.isfinite(cost) & (prediction.worst_failure <= self.p_fail_max)
        return np.where(valid, cost, np.inf)

    def parameters(self, samples: Array) -> Array:
        """Action parameters, shape (n_arrivals * n, p); all samples of the first displacement come first."""
        count, arrivals = len(samples), len(self._displacements)
        parameters = np.empty((arrivals, count, len(self._template)))
        parameters[:] = self._template
        parameters[:, :, self.slots] = samples[:, self.sources]
        if arrivals > 1:
            exact = parameters[:, :, self._displaced]
            parameters[:, :, self._displaced] = self._clip(exact + self._displacements[:, None, :], exact)
        return parameters.reshape(arrivals * count, -1)

    def _clip(self, displaced: Array, exact: Array) -> Array:
        """Displaced values clipped to the ranges that the models were trained on; angles are not clipped."""
        columns = self._clipped
        lower = np.minimum(exact[:, :, columns], self._lower)
        upper = np.maximum(exact[:, :, columns], self._upper)
        displaced[:, :, columns] = np.minimum(np.maximum(displaced[:, :, columns], lower), upper)
        return displaced


def context_cost_s(instance: InstantiatedAction, settings: RefinementSettings) -> float:
    """Price of meeting an object, at least that of a failure. Settings without a price keep none."""
    context = instance.action.context
    if context is None or settings.risk_cost_s == 0:
        return 0.0
    return max(settings.risk_cost_s, context.failure_cost_s)


def _displacements(parameters: Sequence[Parameter], settings: RefinementSettings) -> Array:
    """Displacements on arrival; those of an angle are the same arrivals within half a period.

    A proof distinguishes each half turn that the arrivals of a box may lie in: of a spread without limit, millions.
    """
    points = displacements([parameter.quantity for parameter in parameters], dict(settings.arrival_spread))
    for column, parameter in enumerate(parameters):
        points[:, column] = [math.remainder(point, parameter.period) for point in points[:, column]]
    return points


def _mean(values: Array, arrivals: int) -> Array:
    """Mean over the displaced arrivals, shape (n,), of values (arrivals * n,); three times faster than np.mean."""
    if arrivals == 1:
        return values
    total: Array = np.add.reduce(values.reshape(arrivals, -1), axis=0)
    return total / arrivals
