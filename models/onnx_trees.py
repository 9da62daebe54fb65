"""Writes fitted trees into ONNX graphs, bit for bit what their numpy form computes but for the order of sums."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import TensorProto

from models.linear_tree import LinearTree
from models.onnx_graph import ML, Sink
from models.split_tree import LEAF, SplitTree


def add_ensemble(sink: Sink, features: str, trees: Sequence[SplitTree], values: Sequence[NDArray[np.float32]]) -> str:
    """Tree k's leaf values, shape (l_k, t), go to targets of its own: features (n, f) to (n, sum of t)."""
    rows: dict[str, list[Any]] = {name: [] for name in ENSEMBLE}
    first = 0
    for number, (tree, value) in enumerate(zip(trees, values, strict=True)):
        for node, feature in enumerate(tree.feature):
            inner = feature != LEAF
            row = (number, node, max(int(feature), 0), "BRANCH_LEQ" if inner else "LEAF", float(tree.threshold[node]))
            for name, item in zip(ENSEMBLE[:7], (*row, int(tree.left[node]), int(tree.right[node])), strict=True):
                rows[name].append(item)
            if not inner:
                for target, weight in enumerate(value[tree.leaf[node]]):
                    for name, item in zip(ENSEMBLE[7:], (number, node, first + target, float(weight)), strict=True):
                        rows[name].append(item)
        first += value.shape[1]
    return str(sink.add("TreeEnsembleRegressor", features, domain=ML, n_targets=first, post_transform="NONE", **rows))


ENSEMBLE = (
    "nodes_treeids", "nodes_nodeids", "nodes_featureids", "nodes_modes", "nodes_values", "nodes_truenodeids",
    "nodes_falsenodeids", "target_treeids", "target_nodeids", "target_ids", "target_weights",
)  # fmt: skip


def _table(tree: LinearTree) -> NDArray[np.float32]:
    """Leaf rows: slopes, intercept, low, high, spread; shape (l, f + 4)."""
    return np.column_stack([tree.slopes, tree.intercept, tree.low, tree.high, tree.spread]).astype(np.float32)


def add_tree(sink: Sink, features: str, tree: LinearTree) -> tuple[str, str]:
    """One model tree: mean and spread, shapes (n,), of features (n, f)."""
    leaves = add_ensemble(sink, features, [tree.splits], [_table(tree)])
    sizes = sink.constant(np.array([tree.slopes.shape[1], 1, 1, 1, 1]))
    slopes, intercept, low, high, spread = sink.add("Split", leaves, sizes, outputs=5, axis=1)
    mean = _formula(sink, features, (slopes, intercept, low, high))
    flat = sink.constant(np.array([-1]))
    return str(sink.add("Reshape", mean, flat)), str(sink.add("Reshape", spread, flat))


def add_bag(sink: Sink, features: str, trees: Sequence[LinearTree]) -> tuple[str, str]:
    """A bag of k model trees: mean and standard deviation over the trees, shapes (n,), of features (n, f)."""
    offsets = np.cumsum([0, *(tree.leaves for tree in trees[:-1])])
    numbers = [np.arange(o, o + t.leaves, dtype=np.float32)[:, None] for o, t in zip(offsets, trees, strict=True)]
    leaf = add_ensemble(sink, features, [tree.splits for tree in trees], numbers)  # (n, k), whole numbers
    leaf = sink.add("Cast", leaf, to=TensorProto.INT64)
    rows = sink.add("Gather", sink.constant(np.concatenate([_table(t)[:, :-1] for t in trees])), leaf, axis=0)
    sizes = sink.constant(np.array([trees[0].slopes.shape[1], 1, 1, 1]))
    parts = sink.add("Split", rows, sizes, outputs=4, axis=2)
    wide = sink.add("Unsqueeze", features, sink.constant(np.array([1])))  # (n, 1, f)
    each = _formula(sink, wide, parts)  # (n, k, 1)
    over = sink.constant(np.array([1, 2]))
    mean = sink.add("ReduceMean", each, over, keepdims=1)
    off = sink.add("Sub", each, mean)
    variance = sink.add("ReduceMean", sink.add("Mul", off, off), over, keepdims=0)
    return str(sink.add("Reshape", mean, sink.constant(np.array([-1])))), str(sink.add("Sqrt", variance))


def _formula(sink: Sink, features: str, parts: Sequence[str]) -> str:
    """clip(features · slopes + intercept, low, high) along the last axis."""
    slopes, intercept, low, high = parts
    product = sink.add("Mul", features, slopes)
    total = sink.add("Add", sink.add("ReduceSum", product, sink.constant(np.array([-1])), keepdims=1), intercept)
    return str(sink.add("Min", sink.add("Max", total, low), high))


def add_steps(sink: Sink, features: str, tree: SplitTree, values: NDArray[np.float32]) -> str:
    """A tree with a constant in each leaf: shape (n,)."""
    column = add_ensemble(sink, features, [tree], [values[:, None]])
    return str(sink.add("Reshape", column, sink.constant(np.array([-1]))))
