"""Writes fitted trees into ONNX graphs, bit for bit what their numpy form computes but for the order of sums."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import TensorProto

from models.cells import Cells, cells_of
from models.linear_tree import LinearTree
from models.onnx_graph import ML, Sink
from models.split_tree import LEAF, SplitTree

ENSEMBLE = (
    "nodes_treeids", "nodes_nodeids", "nodes_featureids", "nodes_modes", "nodes_values", "nodes_truenodeids",
    "nodes_falsenodeids", "target_treeids", "target_nodeids", "target_ids", "target_weights",
)  # fmt: skip
STEEP = 1e38  # a ramp that is 1 where any two different numbers are apart


def add_steps(sink: Sink, features: str, steps: Sequence[tuple[SplitTree, NDArray[np.float32]]]) -> str:
    """The sum of trees with one number in each leaf, (l,): features (n, f) to (n, 1)."""
    rows: dict[str, list[Any]] = {name: [] for name in ENSEMBLE}
    for number, (tree, values) in enumerate(steps):
        for node, feature in enumerate(tree.feature):
            inner = feature != LEAF
            row = (number, node, max(int(feature), 0), "BRANCH_LEQ" if inner else "LEAF", float(tree.threshold[node]))
            for name, item in zip(ENSEMBLE[:7], (*row, int(tree.left[node]), int(tree.right[node])), strict=True):
                rows[name].append(item)
            if not inner:
                for name, item in zip(ENSEMBLE[7:], (number, node, 0, float(values[tree.leaf[node]])), strict=True):
                    rows[name].append(item)
    return str(sink.add("TreeEnsembleRegressor", features, domain=ML, n_targets=1, post_transform="NONE", **rows))


def add_probability(sink: Sink, features: str, steps: Sequence[tuple[SplitTree, NDArray[np.float32]]]) -> str:
    """The mean of trees with a probability in each leaf: features (n, f) to (n,)."""
    parts = [(tree, values / np.float32(len(steps))) for tree, values in steps]
    return _flat(sink, add_steps(sink, features, parts))


def add_tree(sink: Sink, features: str, tree: LinearTree) -> tuple[str, str]:
    """One model tree: mean and spread, shapes (n,), of features with a one (n, f + 1)."""
    leaf = _leaves(sink, features, [tree])
    mean = _formula(sink, features, leaf, [tree])
    return _flat(sink, mean), _flat(sink, str(sink.add("Gather", sink.constant(tree.spread), leaf)))


def add_bag(sink: Sink, features: str, trees: Sequence[LinearTree]) -> tuple[str, str]:
    """A bag of k model trees: mean and standard deviation over the trees, shapes (n,), of features (n, f + 1)."""
    width = trees[0].slopes.shape[1]
    cells = cells_of([tree.splits for tree in trees], width)
    leaves = _leaves(sink, features, trees) if cells is None else _leaves_by_cell(sink, features, cells, width)
    each = _formula(sink, features, leaves, trees)  # (k, n, 1)
    over = sink.constant(np.array([0]))
    mean = sink.add("ReduceMean", each, over, keepdims=1)
    off = sink.add("Sub", each, mean)
    variance = sink.add("ReduceMean", sink.add("Mul", off, off), over, keepdims=1)
    return _flat(sink, mean), _flat(sink, str(sink.add("Sqrt", variance)))


def _leaves(sink: Sink, features: str, trees: Sequence[LinearTree]) -> str:
    """Leaf numbers, counted on from tree to tree, shape (k, n).

    One ensemble for each tree: one ensemble with several targets costs eight times as much.
    """
    columns, first = [], 0
    for tree in trees:
        numbers = np.arange(first, first + tree.leaves, dtype=np.float32)  # whole numbers, exact below 2**24
        columns.append(add_steps(sink, features, [(tree.splits, numbers)]))
        first += tree.leaves
    stacked = sink.add("Concat", *columns, axis=0) if len(columns) > 1 else columns[0]  # (k·n, 1)
    rows = sink.add("Reshape", stacked, sink.constant(np.array([len(trees), -1])))
    return str(sink.add("Cast", rows, to=TensorProto.INT32))


def _leaves_by_cell(sink: Sink, features: str, cells: Cells, width: int) -> str:
    """The same from tables of cells in half the time: who walks down a tree waits for branches that were guessed wrong.

    `x - threshold` is a product with ones and zeros, so its sign is exact; a steep ramp makes 0 or 1 of it.
    """
    count = len(cells.threshold)
    minus = np.zeros((width + 1, count), np.float32)
    minus[cells.feature, np.arange(count)] = 1.0
    minus[width] = -cells.threshold
    beyond = sink.add("MatMul", features, sink.constant(minus))  # (n, u)
    beyond = sink.add("HardSigmoid", beyond, alpha=STEEP, beta=0.0)
    first = sink.constant(cells.first[:, None])
    cell = sink.add("Gemm", sink.constant(cells.strides), beyond, first, transA=1, transB=1)  # (k, n)
    limits = (sink.constant(np.array(limit, np.int32)) for limit in (0, len(cells.leaf) - 1))
    # what is not a number may be cast to any cell: its formula gives no number either
    number = sink.add("Clip", sink.add("Cast", cell, to=TensorProto.INT32), *limits)
    leaf = sink.add("Gather", sink.constant(cells.leaf.astype(np.uint16)), number)
    return str(sink.add("Cast", leaf, to=TensorProto.INT32))


def _formula(sink: Sink, features: str, leaf: str, trees: Sequence[LinearTree]) -> str:
    """clip(features · slopes + intercept, low, high) of leaves (k, n): seconds (k, n, 1).

    One table of rows (slopes, intercept, low, high): what costs time is to look up, not to compute.
    """
    rows = [np.column_stack([tree.slopes, tree.intercept, tree.low, tree.high]) for tree in trees]
    row = sink.add("Gather", sink.constant(np.concatenate(rows)), leaf)  # (k, n, f + 3)
    widths = sink.constant(np.array([rows[0].shape[1] - 2, 1, 1]))
    slopes, low, high = sink.add("Split", row, widths, outputs=3, axis=2)
    total = sink.add("ReduceSum", sink.add("Mul", slopes, features), sink.constant(np.array([-1])), keepdims=1)
    return str(sink.add("Min", sink.add("Max", total, low), high))


def _flat(sink: Sink, values: str) -> str:
    return str(sink.add("Reshape", values, sink.constant(np.array([-1]))))
