"""Reads tables of cells back out of a graph, as the boxes of features that each leaf holds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.onnx_wire import Contents

Floats = NDArray[np.float32]
Ints = NDArray[np.int64]


def boxes_of_cells(graph: Contents, features: int) -> tuple[Ints, Floats, Floats, Floats] | None:
    """First leaf of each tree, box of each leaf (lower < x <= upper), and its number; None where there are no cells.

    The counterpart of `onnx_trees._leaves_by_cell`: products with thresholds, with strides, then the table.
    """
    by_op = {node.op: node for node in graph.nodes if node.op in ("HardSigmoid", "Clip")}
    made = {name: node for node in graph.nodes for name in node.outputs}
    readers = {name: node for node in graph.nodes for name in node.inputs}
    if len(by_op) != 2:
        return None
    minus = graph.constants[made[by_op["HardSigmoid"].inputs[0]].inputs[1]]  # (f + 1, u)
    sums = readers[by_op["HardSigmoid"].outputs[0]]
    strides, first = (graph.constants[sums.inputs[k]] for k in (0, 2))  # (u, k), (k, 1)
    leaf = graph.constants[readers[by_op["Clip"].outputs[0]].inputs[0]]
    feature = np.argmax(minus[:features] == 1.0, axis=0)
    ends = np.append(first[1:, 0], len(leaf)).astype(np.int64)
    parts = [
        _tree(feature, -minus[features], strides[:, k], leaf[int(first[k, 0]) : ends[k]], features)
        for k in range(len(first))
    ]
    starts = np.cumsum([0, *(len(part[2]) for part in parts)])[:-1]
    lower, upper, said = (np.concatenate(column) for column in zip(*parts, strict=True))
    return starts, lower, upper, said


def _tree(
    feature: NDArray[np.intp], threshold: Floats, stride: Floats, leaf: NDArray[np.int32], features: int
) -> tuple[Floats, Floats, Floats]:
    """Boxes and numbers of one tree's leaves: a leaf reaches from its first cell to its last along each feature."""
    own = [threshold[(feature == f) & (stride > 0)] for f in range(features)]
    sizes = [len(some) + 1 for some in own]
    numbers, place = np.unique(leaf, return_inverse=True)
    lower, upper = (np.empty((len(numbers), features), np.float32) for _ in range(2))
    for f, at in enumerate(np.unravel_index(np.arange(len(leaf)), sizes)):
        lowest, highest = np.full(len(numbers), sizes[f]), np.zeros(len(numbers), np.int64)
        np.minimum.at(lowest, place, at)
        np.maximum.at(highest, place, at)
        edges = np.concatenate([[-np.inf], own[f], [np.inf]]).astype(np.float32)
        lower[:, f], upper[:, f] = edges[lowest], edges[highest + 1]
    return lower, upper, numbers.astype(np.float32)
