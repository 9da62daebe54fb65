"""Rows of one episode are near copies: learners number, hold out and resample whole episodes, never rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.int64]
Seed = int | np.random.Generator | None  # None is seed 0: without a word, the same trees again


def numbered(groups: Any, rows: int) -> Numbers:
    """The episode of each row, shape (rows,), counted from 0; without groups every row is one."""
    labels = np.arange(rows) if groups is None else np.asarray(groups)
    return np.unique(labels, return_inverse=True)[1]


def held_out(episodes: Numbers, share: float, seed: Seed) -> NDArray[np.bool_]:
    """Rows, shape (n,), of a random share of the episodes: those that a tree does not grow on."""
    count = int(episodes.max()) + 1
    chosen = np.random.default_rng(seed or 0).permutation(count)[: int(share * count)]
    return np.isin(episodes, chosen)


def resampled(episodes: Numbers, rng: np.random.Generator) -> NDArray[np.float64]:
    """How often each row's episode was drawn, shape (n,), when as many as there are are drawn with replacement."""
    count = int(episodes.max()) + 1
    return np.bincount(rng.integers(0, count, count), minlength=count)[episodes].astype(np.float64)
