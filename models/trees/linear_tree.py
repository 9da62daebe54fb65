"""The fitted form of a model tree: splits, and for each leaf a linear formula, a clip range and a spread.

Everything is single precision: what the ONNX runtime computes is what is computed here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tailor.models.trees.split_tree import Floats, Ints, SplitRow, SplitTree

LeafRow = tuple[NDArray[np.float64], float, float, float, float, int]  # slopes, intercept, low, high, spread, rows


@dataclass(frozen=True, slots=True)
class LinearTree:
    """A model tree over f features with l leaves: a leaf predicts `clip(x @ slopes + intercept, low, high)`."""

    splits: SplitTree
    slopes: Floats  # (l, f), seconds per unit of each feature
    intercept: Floats  # (l,) seconds
    low: Floats  # (l,) seconds: nothing shorter was seen in this leaf
    high: Floats  # (l,) seconds
    std: Floats  # (l,) seconds: standard deviation of what was seen around the formula
    rows: Ints  # (l,) examples that the leaf was fitted to

    @classmethod
    def of(cls, nodes: Sequence[SplitRow], leaves: Sequence[LeafRow]) -> LinearTree:
        """A tree of node rows and leaf rows."""
        slopes, *rest, rows = zip(*leaves, strict=True)
        numbers = (np.asarray(column, np.float32) for column in rest)
        return cls(SplitTree.of(nodes), np.asarray(slopes, np.float32), *numbers, np.asarray(rows))

    def with_std(self, spread: Floats) -> LinearTree:
        """The same tree with other spreads, (l,)."""
        return replace(self, std=spread)

    @property
    def leaves(self) -> int:
        """Number of leaves."""
        return len(self.intercept)

    def predict(self, features: Floats) -> Floats:
        """Seconds, shape (n,), for features of shape (n, f) in single precision."""
        leaf = self.splits.leaf_of(features)
        total = (features * self.slopes[leaf]).sum(axis=1) + self.intercept[leaf]
        return np.clip(total, self.low[leaf], self.high[leaf])
