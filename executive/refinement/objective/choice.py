"""A choice of the free parameters, and what the models predict for it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective


@dataclass(frozen=True, slots=True)
class Choice:
    """Values for the free parameters within the horizon, and what the models predict for them.

    Tuples have one entry for each action within the horizon, detours included. `total_s` is the objective's value
    (mean + k std, penalties); +inf when the choice is not valid.
    """

    values: dict[int, float]  # by variable id
    predicted_s: tuple[float, ...]
    spread_s: tuple[float, ...]
    failure: tuple[float, ...]  # predicted probability of failure
    total_s: float
    valid: bool


def choice_of(objective: SequenceObjective, candidate: Array) -> Choice:
    """The choice that a candidate, shape (d,), stands for."""
    total_s = float(objective(candidate[None])[0])
    predictions = objective.predict(candidate)
    return Choice(
        objective.values(candidate),
        tuple(float(said.duration_s[0]) for said in predictions),
        tuple(float(said.spread_s[0]) for said in predictions),
        tuple(float(said.failure[0]) for said in predictions),
        total_s,
        math.isfinite(total_s),
    )
