"""The fitted form of a model tree: splits, and for each leaf a linear formula, a clip range and a standard deviation.

All arrays are single precision, as in the ONNX runtime, so that both compute the same numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.split_tree import Floats, Ints, SplitRow, SplitTree

LeafRow = tuple[NDArray[np.float64], float, float, float, float, int]  # slopes, intercept, low, high, std, rows


@dataclass(frozen=True, slots=True)
class LinearTree:
    """A model tree over f features with l leaves: a leaf predicts `clip(x @ slopes + intercept, low, high)`."""

    splits: SplitTree
    slopes: Floats  # (l, f), seconds per unit of each feature
    intercept: Floats  # (l,) seconds
    low: Floats  # (l,) seconds: shortest training target in the leaf
    high: Floats  # (l,) seconds: longest training target in the leaf
    std: Floats  # (l,) seconds: standard deviation of the training targets around the formula
    rows: Ints  # (l,) number of examples that the leaf was fitted to

    @classmethod
    def of(cls, nodes: Sequence[SplitRow], leaves: Sequence[LeafRow]) -> LinearTree:
        """A tree of node rows and leaf rows."""
        slopes, intercept, low, high, std = (
            np.asarray([leaf[k] for leaf in leaves], np.float32) for k in range(len(leaves[0]) - 1)
        )
        rows = np.asarray([leaf[-1] for leaf in leaves])
        return cls(SplitTree.of(nodes), slopes, intercept, low, high, std, rows)

    def with_std(self, std: Floats) -> LinearTree:
        """The same tree with other standard deviations, shape (l,)."""
        return replace(self, std=std)

    @property
    def leaves(self) -> int:
        """Number of leaves."""
        return len(self.intercept)

    def predict(self, features: Floats) -> Floats:
        """Seconds, shape (n,), for features of shape (n, f) in single precision."""
        leaf = self.splits.leaf_of(features)
        total = (features * self.slopes[leaf]).sum(axis=1) + self.intercept[leaf]
        seconds: Floats = np.clip(total, self.low[leaf], self.high[leaf])
        return seconds
