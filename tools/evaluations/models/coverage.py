"""Predictions of duration models with their 90 % intervals, and what these hold: of all, and of thirds by spread."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.models.inference import OnnxDuration


@dataclass(frozen=True, slots=True)
class Predicted:
    """Predictions for n episodes; every field has shape (n,)."""

    mean_s: Array
    std_s: Array
    lower_s: Array
    upper_s: Array


def predicted_by(
    model: OnnxDuration, beside: OnnxDuration, arguments: Array, in_context: NDArray[np.bool_]
) -> Predicted:
    """Predictions for arguments, shape (n, k): by the model `beside` where `in_context`, shape (n,), is true."""
    alone, near = ((*each.interval(arguments), each.predict(arguments)[1]) for each in (model, beside))
    mean, lower, upper, std = (np.where(in_context, b, a) for a, b in zip(alone, near, strict=True))
    return Predicted(mean, std, lower, upper)


def coverage_columns(predicted: Predicted, observed_s: Array) -> dict[str, Any]:
    """Percent of the observed durations, shape (n,), within their intervals; NaN of a third without any."""
    lower, upper = predicted.lower_s, predicted.upper_s
    held = (lower <= observed_s) & (observed_s <= upper)
    thirds = np.array_split(np.argsort(predicted.std_s, kind="stable"), 3)
    return {
        "coverage_pct": 100 * float(held.mean()),
        "coverage_thirds_pct": tuple(100 * float(held[third].mean()) if len(third) else math.nan for third in thirds),
        "interval_s": float(np.mean(upper - lower)),
    }
