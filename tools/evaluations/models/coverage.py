"""Coverage of the models' 90 % intervals, over all episodes and in thirds of predicted spread."""

from __future__ import annotations

from typing import Any

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.models.inference import OnnxDuration


def coverage_columns(model: OnnxDuration, arguments: Array, observed_s: Array, spread_s: Array) -> dict[str, Any]:
    """Percent of the observed durations within the interval.

    Args:
      model: Duration model.
      arguments: Controller arguments, shape (n, k).
      observed_s: Observed durations, shape (n,).
      spread_s: Predicted standard deviations, shape (n,).
    """
    _, lower, upper = model.interval(arguments)
    held = (lower <= observed_s) & (observed_s <= upper)
    thirds = np.array_split(np.argsort(spread_s, kind="stable"), 3)
    return {
        "coverage_pct": 100 * float(held.mean()),
        "coverage_thirds_pct": tuple(100 * float(held[third].mean()) for third in thirds),
        "interval_s": float(np.mean(upper - lower)),
    }
