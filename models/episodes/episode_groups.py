"""Selection of rows by whole episodes: rows of one episode are near copies and must stay together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.int64]
Seed = int | np.random.Generator | None  # None is seed 0: training is reproducible by default


def episode_indices(groups: Any, rows: int) -> Numbers:
    """Episode of each row, shape (rows,), numbered from 0; without groups every row is an episode of its own."""
    labels = np.arange(rows) if groups is None else np.asarray(groups)
    return np.unique(labels, return_inverse=True)[1]


def held_out_rows(episodes: Numbers, share: float, seed: Seed) -> NDArray[np.bool_]:
    """Rows, shape (n,), of a random share of the episodes, to be held out from growing a tree."""
    count = int(episodes.max()) + 1
    chosen = np.random.default_rng(seed or 0).permutation(count)[: int(share * count)]
    return np.isin(episodes, chosen)


def bootstrap_weights(episodes: Numbers, rng: np.random.Generator) -> NDArray[np.float64]:
    """How often each row's episode is drawn, shape (n,), in one bootstrap sample of the episodes."""
    count = int(episodes.max()) + 1
    return np.bincount(rng.integers(0, count, count), minlength=count)[episodes].astype(np.float64)
