"""Trees as tables of cells: the thresholds of each feature divide space into a grid, and each cell lies in one leaf.

Finding a cell takes only comparisons and sums, as matrix products, and no branches that a processor mispredicts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.split_tree import SplitTree

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]

MAX_CELLS = 1 << 20  # of all trees: a table of 2 MB, which fits into a processor's cache
MAX_LEAVES = 1 << 16  # a table's numbers take two bytes


@dataclass(frozen=True, slots=True)
class Cells:
    """k trees over u thresholds in all; a row x lies in cell `strides.T @ (x[feature] > threshold) + first` of each.

    Every whole number in it is below 2**24, so single precision counts exactly.
    """

    feature: Ints  # (u,) that each threshold is of
    threshold: Floats  # (u,)
    strides: Floats  # (u, k) how many cells of a tree lie between both sides of a threshold; 0: not this tree's
    first: Floats  # (k,) first cell of each tree in the table
    leaf: Ints  # (cells,) leaf numbers, from 0 in each tree


def cells_of(trees: Sequence[SplitTree], features: int) -> Cells | None:
    """Cells of trees over `features` features; None if there are more than MAX_CELLS, or no tree has a split."""
    own = [_thresholds(tree, features) for tree in trees]
    sizes = [int(np.prod([len(some) + 1 for some in each])) for each in own]
    leaves = [tree.leaves for tree in trees]
    if max(leaves) == 1 or max(leaves) > MAX_LEAVES or sum(sizes) > MAX_CELLS:
        return None
    union = [np.unique(np.concatenate([each[f] for each in own])) for f in range(features)]
    strides = np.stack([_strides(each, union) for each in own], axis=1)
    leaf = [tree.leaf_of(_corners(each)) for tree, each in zip(trees, own, strict=True)]
    return Cells(
        np.repeat(np.arange(features), [len(some) for some in union]).astype(np.int32),
        np.concatenate(union),
        strides,
        np.cumsum([0, *sizes[:-1]]).astype(np.float32),
        np.concatenate(leaf).astype(np.int32),
    )


def _thresholds(tree: SplitTree, features: int) -> list[Floats]:
    """Each feature's thresholds in a tree, rising."""
    return [np.unique(tree.threshold[tree.feature == feature]) for feature in range(features)]


def _strides(own: Sequence[Floats], union: Sequence[Floats]) -> Floats:
    """Increment of the cell number by each threshold of the union in one tree, (u,); the last feature has stride 1."""
    steps = np.cumprod([1, *(len(some) + 1 for some in own[:0:-1])])[::-1]
    parts = [np.where(np.isin(every, some), step, 0) for every, some, step in zip(union, own, steps, strict=True)]
    return np.concatenate(parts).astype(np.float32)


def _corners(own: Sequence[Floats]) -> Floats:
    """The upper corner of every cell, which lies in it: shape (cells, f), in the order of their numbers."""
    axes = [np.append(some, np.float32(np.inf)) for some in own]
    return np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
