"""What a regression model may predict of an action: its duration, or the energy that it takes; each with its unit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tailor.models.episodes.episodes import Episode
from tailor.models.episodes.examples import Examples, duration_examples, energy_examples


@dataclass(frozen=True, slots=True)
class RegressionTarget:
    """A quantity that an action takes in the whole, and of which less remains at every tick."""

    kind: str  # of model
    unit: str  # as field names end: "s"
    examples: Callable[[Sequence[Episode], int], Examples]  # what remains at the first n_i ticks
    is_recorded: Callable[[Episode], bool]  # whether a finished episode holds the quantity
    whole: Callable[[Episode], float]


def _energy_j(episode: Episode) -> float:
    return 0.0 if episode.work_j is None else float(episode.work_j.sum())


DURATION = RegressionTarget("duration", "s", duration_examples, lambda _: True, lambda episode: episode.duration_s)
ENERGY = RegressionTarget("energy", "j", energy_examples, lambda episode: episode.work_j is not None, _energy_j)
REGRESSION_TARGETS = {amount.kind: amount for amount in (DURATION, ENERGY)}
