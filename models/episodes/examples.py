"""Turns episodes into training examples: the first n_i ticks of each, with what remains as the target (paper 5.1)."""

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
    """n rows to learn from; rows of one episode are near copies and must stay together."""

    arguments: Array  # (n, k)
    targets: Array  # (n,) seconds or joules that remain, or 1 for success and 0 for failure
    groups: Numbers  # (n,) number of the episode

    def of(self, episodes: Numbers) -> Examples:
        """The rows of some episodes."""
        chosen = np.isin(self.groups, episodes)
        return Examples(self.arguments[chosen], self.targets[chosen], self.groups[chosen])


def duration_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Remaining durations at the first n_i ticks of each episode that its controller finished."""
    return _examples(episodes, n_i, lambda e: e.duration_s - TICK_S * np.arange(len(e.ticks)))


def energy_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Joules that remain at the first n_i ticks of each episode whose work was told."""
    told = [episode for episode in episodes if episode.work_j is not None]
    return _examples(told, n_i, lambda e: np.cumsum(e.work_j[::-1])[::-1])


def success_examples(episodes: Sequence[Episode], n_i: int) -> Examples:
    """Outcomes at the first n_i ticks of each episode."""
    return _examples(episodes, n_i, lambda e: np.full(len(e.ticks), float(e.success)))


def _examples(episodes: Sequence[Episode], n_i: int, target: Callable[[Episode], Array]) -> Examples:
    rows, targets, groups = [], [], []
    for episode in episodes:
        rows.append(episode.ticks[:n_i])
        targets.append(target(episode)[:n_i])
        groups.append(np.full(len(rows[-1]), episode.number))
    return Examples(np.concatenate(rows), np.concatenate(targets), np.concatenate(groups))


def split(groups: Numbers, share: float, rng: np.random.Generator) -> tuple[Numbers, Numbers]:
    """Numbers of the episodes to train on, and of the `share` to test with; never one episode in both."""
    numbers = rng.permutation(np.unique(groups))
    cut = round(share * len(numbers))
    return np.sort(numbers[cut:]), np.sort(numbers[:cut])


def folds(groups: Numbers, count: int, rng: np.random.Generator) -> list[Numbers]:
    """Episodes in `count` parts of about equal size."""
    return [np.sort(part) for part in np.array_split(rng.permutation(np.unique(groups)), count)]
