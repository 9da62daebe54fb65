"""Converts episodes into training examples: the first n_i ticks of each, targets from there on (paper 5.1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.episodes.episodes import TICK_S, Episode

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Examples:
    """n training examples; rows of one episode are near copies and must stay together."""

    arguments: Array  # (n, k)
    targets: Array  # (n,) remaining seconds or joules, or 1 for success and 0 for failure
    groups: Numbers  # (n,) number of the episode

    def of(self, episodes: Numbers) -> Examples:
        """The rows of the episodes with these numbers."""
        chosen = np.isin(self.groups, episodes)
        return Examples(self.arguments[chosen], self.targets[chosen], self.groups[chosen])


def duration_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Remaining durations, in seconds, at the first n_i ticks of each episode."""
    return _examples(episodes, n_i, _remaining_s)


def energy_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Remaining energies, in joules, at the first n_i ticks of each episode whose work was recorded."""
    recorded = [episode for episode in episodes if episode.work_j is not None]
    return _examples(recorded, n_i, _remaining_j)


def success_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Outcomes, 1 or 0, at the first n_i ticks of each episode."""
    return _examples(episodes, n_i, lambda e: np.full(len(e.ticks), float(e.success)))


def _remaining_s(episode: Episode) -> Array:
    seconds: Array = episode.duration_s - TICK_S * np.arange(len(episode.ticks), dtype=np.float64)
    return seconds


def _remaining_j(episode: Episode) -> Array:
    assert episode.work_j is not None
    return np.cumsum(episode.work_j[::-1])[::-1]


def _examples(episodes: Sequence[Episode], n_i: int, target: Callable[[Episode], Array]) -> Examples:
    rows, targets, groups = [], [], []
    for episode in episodes:
        rows.append(episode.ticks[:n_i])
        targets.append(target(episode)[:n_i])
        groups.append(np.full(len(rows[-1]), episode.number))
    return Examples(np.concatenate(rows), np.concatenate(targets), np.concatenate(groups))


def split(groups: Numbers, share: float, rng: np.random.Generator) -> tuple[Numbers, Numbers]:
    """Numbers of the episodes to train on, and of a random `share` to test on; no episode is in both."""
    numbers = rng.permutation(np.unique(groups))
    cut = round(share * len(numbers))
    return np.sort(numbers[cut:]), np.sort(numbers[:cut])


def folds(groups: Numbers, count: int, rng: np.random.Generator) -> list[Numbers]:
    """Numbers of the episodes in `count` random parts of about equal size."""
    return [np.sort(part) for part in np.array_split(rng.permutation(np.unique(groups)), count)]
