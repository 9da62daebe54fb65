"""Reads tables of cells from an ONNX graph, as the box of features of each leaf."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.onnx_reader import Contents
from tailor.models.fitted_trees import tree_names

Floats = NDArray[np.float32]
Ints = NDArray[np.int64]
Boxes = tuple[Ints, Floats, Floats, Floats]


def boxes_of_cells(graph: Contents, features: int) -> Boxes:
    """First leaf of each tree, box of each leaf (lower < x <= upper), and its number in its tree.

    Inverse of `onnx_leaves._by_cells`: products with thresholds, with strides, then the table.

    Raises:
      KeyError: The graph has no tables of cells.
    """
    minus, strides = graph.constants[tree_names.BEYOND], graph.constants[tree_names.STRIDES]
    first, leaf = graph.constants[tree_names.FIRST][:, 0].astype(np.int64), graph.constants[tree_names.LEAF]
    feature = np.argmax(minus[:, :features] == 1.0, axis=1)
    ends = [*first[1:], len(leaf)]
    parts = [
        _tree(feature, -minus[:, features], stride, leaf[start:end], features)
        for stride, start, end in zip(strides, first, ends, strict=True)
    ]
    starts = np.cumsum([0, *(len(part[2]) for part in parts)])[:-1]
    lower, upper, number = (np.concatenate(column) for column in zip(*parts, strict=True))
    return starts, lower, upper, number


def _tree(
    feature: NDArray[np.intp], threshold: Floats, stride: Floats, leaf: NDArray[np.int32], features: int
) -> tuple[Floats, Floats, Floats]:
    """Boxes and numbers of one tree's leaves: a leaf reaches from its first cell to its last along each feature."""
    own = [threshold[(feature == f) & (stride > 0)] for f in range(features)]
    order = np.argsort(leaf, kind="stable")  # the cells of one leaf side by side
    numbers = leaf[order]
    starts = np.flatnonzero(np.concatenate([[True], numbers[1:] != numbers[:-1]]))
    lower, upper = (np.empty((len(starts), features), np.float32) for _ in range(2))
    for f, cells in enumerate(np.unravel_index(order, [len(some) + 1 for some in own])):
        edges = np.concatenate([[-np.inf], own[f], [np.inf]]).astype(np.float32)
        lower[:, f] = edges[np.minimum.reduceat(cells, starts)]
        upper[:, f] = edges[np.maximum.reduceat(cells, starts) + 1]
    return lower, upper, numbers[starts].astype(np.float32)
