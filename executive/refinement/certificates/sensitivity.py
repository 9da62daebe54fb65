"""Sensitivity of the cost to each free parameter: a side of a box with a high sensitivity is bisected first."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective

PROBES = 16  # candidates at which each parameter is moved
PROBE_STEP = 0.05  # share of its range
MIN_CHANGE_S = 1e-3  # for a parameter without a measured change


def sensitivity(objective: SequenceObjective) -> Array:
    """Change of the cost by each free parameter in seconds a unit, shape (d,); the probes are always the same."""
    ranges, count = objective.ranges, objective.ranges.count
    probes = ranges.draw(PROBES, np.random.default_rng(0))
    moved = np.tile(probes, (count + 1, 1, 1))  # the last ones stay
    columns = np.arange(count)
    moved[columns, :, columns] += PROBE_STEP * ranges.width[:, None]
    moved = ranges.confine(moved.reshape(-1, count)).reshape(moved.shape)
    costs = np.zeros(moved.shape[:2])
    for stage in objective.stages:  # the others' parameters do not change its cost
        own = [*stage.columns, count]
        cost = stage.cost(moved[own][:, :, stage.columns].reshape(len(own) * PROBES, -1)).reshape(-1, PROBES)
        every = np.tile(cost[-1], (count + 1, 1))
        every[own] = cost
        costs += every
    valid = np.isfinite(costs[:-1]) & np.isfinite(costs[-1])
    change = np.abs(np.subtract(costs[:-1], costs[-1], out=np.zeros_like(costs[:-1]), where=valid))
    mean = change.sum(axis=1) / np.maximum(valid.sum(axis=1), 1)
    weight: Array = np.zeros(count)  # a parameter whose range is a point is never split
    np.divide(np.maximum(mean, MIN_CHANGE_S), ranges.width, out=weight, where=ranges.width > 0)
    return weight
