"""Coverage of the models' 90 % intervals, over all episodes and in thirds of predicted spread."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import stats

from tailor.executive.interfaces.values import Array
from tailor.models.runtime import OnnxDuration

LEVEL = 0.9


def coverage_columns(model: OnnxDuration, arguments: Array, observed_s: Array, spread_s: Array) -> dict[str, Any]:
    """Percent of the observed durations within the interval.

    Args:
      model: Duration model.
      arguments: Controller arguments, shape (n, k).
      observed_s: Observed durations, shape (n,).
      spread_s: Predicted standard deviations, shape (n,).
    """
    lower, upper = interval(model, arguments)
    held = (lower <= observed_s) & (observed_s <= upper)
    thirds = np.array_split(np.argsort(spread_s, kind="stable"), 3)
    return {
        "coverage_pct": 100 * float(held.mean()),
        "coverage_thirds_pct": tuple(100 * float(held[third].mean()) for third in thirds),
        "interval_s": float(np.mean(upper - lower)),
    }


def interval(model: OnnxDuration, arguments: Array) -> tuple[Array, Array]:
    """Lower and upper ends, each of shape (n,), of the interval that is to hold LEVEL of the durations, seconds."""
    mean, spread = model.predict(arguments)
    factor = model.card["test"].get("interval90_factor", float(stats.norm.ppf(0.5 + LEVEL / 2)))
    half = factor * spread
    return mean - half, mean + half
