"""Choice of the free parameters with the predictions of the models."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective


@dataclass(frozen=True, slots=True)
class Choice:
    """Values of the free parameters within the horizon, and the predictions for them.

    Tuples have one entry for each action within the horizon, asserted subgoals included. `total_s` is the value of the
    objective (mean + k std, penalties); +inf if the choice is not valid.
    """

    values: dict[int, float]  # by variable id
    predicted_s: tuple[float, ...]
    std_s: tuple[float, ...]
    failure: tuple[float, ...]  # predicted probability of failure
    total_s: float
    valid: bool


def any_of(probabilities: Sequence[float]) -> float:
    """Probability that any of independent failures happens."""
    return 1.0 - float(np.prod([1.0 - probability for probability in probabilities]))


def choice_of(objective: SequenceObjective, candidate: Array) -> Choice:
    """Choice for a candidate, shape (d,)."""
    total_s = float(objective(candidate[None])[0])
    predictions = objective.predict(candidate)
    return Choice(
        objective.values(candidate),
        tuple(float(prediction.duration_s[0]) for prediction in predictions),
        tuple(float(prediction.std_s[0]) for prediction in predictions),
        tuple(float(prediction.failure[0]) for prediction in predictions),
        total_s,
        math.isfinite(total_s),
    )
