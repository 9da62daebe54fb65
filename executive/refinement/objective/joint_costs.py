"""Costs of several actions at once: their duration models are run together, because a call costs more than its rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tailor.executive.interfaces.models import DurationModel
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.stage import Stage

MAX_ROWS = 2048  # of one call: the layers of more leave the cache


def joint_costs(stages: Sequence[Stage], samples: Sequence[Array]) -> list[Array]:
    """Cost of each stage in seconds for its own samples, shapes (n,); +inf is INVALID.

    Args:
      stages: The stages.
      samples: Samples of the free parameters for each stage, shape (n, len(columns)).
    """
    parameters = [stage.parameters(own) for stage, own in zip(stages, samples, strict=True)]
    arguments = [stage.action.arguments(rows) for stage, rows in zip(stages, parameters, strict=True)]
    costs: list[Array] = [np.empty(0)] * len(stages)
    for model, indices in _by_model(stages):
        means, stds = _predict(model, [arguments[index] for index in indices])
        for index, mean, std in zip(indices, means, stds, strict=True):
            stage = stages[index]
            costs[index] = stage.cost_of(stage.prediction(parameters[index], arguments[index], mean, std))
    return costs


def _by_model(stages: Sequence[Stage]) -> Iterator[tuple[DurationModel, list[int]]]:
    """Each duration model with the indices of its stages."""
    models: dict[int, list[int]] = {}
    for index, stage in enumerate(stages):
        models.setdefault(id(stage.models.duration), []).append(index)
    for indices in models.values():
        yield stages[indices[0]].models.duration, indices


def _predict(model: DurationModel, arguments: Sequence[Array]) -> tuple[list[Array], list[Array]]:
    """Means and standard deviations for each array of arguments."""
    rows = np.concatenate(arguments)
    parts = [model.predict(rows[first : first + MAX_ROWS]) for first in range(0, max(1, len(rows)), MAX_ROWS)]
    ends = np.cumsum([len(each) for each in arguments])[:-1]
    mean, std = (np.split(np.concatenate(values), ends) for values in zip(*parts, strict=True))
    return mean, std
