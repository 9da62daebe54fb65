"""Targets of regression models: the duration of an action, or its energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tailor.models.episodes.episodes import Episode
from tailor.models.episodes.examples import Examples, duration_examples, energy_examples


@dataclass(frozen=True, slots=True)
class RegressionTarget:
    """A quantity that an action consumes, of which less remains at every tick."""

    kind: str  # kind of model, as in cards
    unit: str  # suffix of field names: "s" or "j"
    examples: Callable[[Sequence[Episode], int], Examples]  # remaining quantity at the first n_i ticks
    is_recorded: Callable[[Episode], bool]  # whether a finished episode holds the quantity
    whole: Callable[[Episode], float]  # quantity of the whole episode


def _energy_j(episode: Episode) -> float:
    return 0.0 if episode.work_j is None else float(episode.work_j.sum())


DURATION = RegressionTarget("duration", "s", duration_examples, lambda _: True, lambda episode: episode.duration_s)
ENERGY = RegressionTarget("energy", "j", energy_examples, lambda episode: episode.work_j is not None, _energy_j)
REGRESSION_TARGETS = {"duration": DURATION, "duration_beside": DURATION, "energy": ENERGY}  # by kind of model
