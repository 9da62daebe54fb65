"""Splits of a fitted tree as arrays in single precision; finds the leaf of each row of features."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Ints = NDArray[np.int64]

LEAF = -1
SplitRow = tuple[int, float, int, int, int]  # feature, threshold, left, right, leaf


@dataclass(frozen=True, slots=True)
class SplitTree:
    """A binary tree with m nodes (node 0 is the root); rows with `x[feature] <= threshold` go left."""

    feature: Ints  # (m,), LEAF at leaves
    threshold: Floats  # (m,)
    left: Ints  # (m,) node numbers
    right: Ints  # (m,)
    leaf: Ints  # (m,) leaf number of a leaf node, -1 elsewhere

    @classmethod
    def of(cls, nodes: Sequence[SplitRow]) -> SplitTree:
        """A tree of node rows."""
        feature, threshold, left, right, leaf = zip(*nodes, strict=True)
        return cls(
            np.asarray(feature),
            np.asarray(threshold, np.float32),
            np.asarray(left),
            np.asarray(right),
            np.asarray(leaf),
        )

    @property
    def leaves(self) -> int:
        """Number of leaves."""
        return int((self.feature == LEAF).sum())

    def leaf_of(self, features: Floats) -> Ints:
        """Leaf number of each row: shape (n, f) to (n,)."""
        node = np.zeros(len(features), np.int64)
        inner = self.feature[node] != LEAF
        while inner.any():
            rows = np.flatnonzero(inner)
            at = node[rows]
            goes_left = features[rows, self.feature[at]] <= self.threshold[at]
            node[rows] = np.where(goes_left, self.left[at], self.right[at])
            inner[rows] = self.feature[node[rows]] != LEAF
        return self.leaf[node]
