"""How much each free parameter matters: a side of a box that matters more is cut first."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective

PROBES = 16  # choices at which each parameter is moved
PROBE_STEP = 0.05  # of its range
MIN_CHANGE_S = 1e-3  # where none is seen


def sensitivity(objective: SequenceObjective) -> Array:
    """Seconds a unit by which each free parameter matters, shape (d,); no random draw but always the same probes."""
    ranges = objective.ranges
    probes = ranges.draw(PROBES, np.random.default_rng(0))
    moved = np.tile(probes, (ranges.count + 1, 1, 1))
    columns = np.arange(ranges.count)
    moved[columns, :, columns] += PROBE_STEP * ranges.width[:, None]
    costs = objective(ranges.confine(moved.reshape(-1, ranges.count))).reshape(ranges.count + 1, PROBES)
    known = np.isfinite(costs[:-1]) & np.isfinite(costs[-1])
    change = np.abs(np.subtract(costs[:-1], costs[-1], out=np.zeros_like(costs[:-1]), where=known))
    mean = change.sum(axis=1) / np.maximum(known.sum(axis=1), 1)
    weight: Array = np.maximum(mean, MIN_CHANGE_S) / ranges.width
    return weight
