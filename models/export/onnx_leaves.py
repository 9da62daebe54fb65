"""Adds the lookup of each tree's leaf to ONNX graphs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import TensorProto

from tailor.models.export.onnx_features import as_columns
from tailor.models.export.onnx_graph import ML, Sink
from tailor.models.features.features import STEEP
from tailor.models.fitted_trees import tree_names
from tailor.models.fitted_trees.cells import Cells, cells_of
from tailor.models.fitted_trees.split_tree import LEAF, SplitTree

ENSEMBLE = (
    "nodes_treeids", "nodes_nodeids", "nodes_featureids", "nodes_modes", "nodes_values", "nodes_truenodeids",
    "nodes_falsenodeids", "target_treeids", "target_nodeids", "target_ids", "target_weights",
)  # fmt: skip


def add_steps(
    sink: Sink, features: str, steps: Sequence[tuple[SplitTree, NDArray[np.float32]]], **attributes: Any
) -> str:
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
    attributes = {"n_targets": 1, "post_transform": "NONE", **rows, **attributes}
    return str(sink.add("TreeEnsembleRegressor", features, domain=ML, **attributes))


def add_number(sink: Sink, features: str, tree: SplitTree, name: str) -> str:
    """Leaf numbers of a single tree, by a node of that name: features (n, f) to (n,)."""
    number = add_steps(sink, features, [(tree, np.arange(tree.leaves, dtype=np.float32))], name=name)
    flat = sink.add("Reshape", number, sink.constant(np.array([-1])))
    return str(sink.add("Cast", flat, to=TensorProto.INT32))


def add_leaves(sink: Sink, features: str, trees: Sequence[SplitTree], width: int) -> str:
    """Leaf numbers (k, n) of k trees over `width` features, each counted from 0; rows with a one: (width + 1, n)."""
    cells = cells_of(trees, width) if len(trees) > 1 else None  # for a single tree the tree operator is as fast
    leaf = _by_ensembles(sink, features, trees) if cells is None else _by_cells(sink, features, cells, width)
    shape = sink.constant(np.array([len(trees), -1]))
    return str(sink.add("Cast", sink.add("Reshape", leaf, shape), to=TensorProto.INT32))


def _by_ensembles(sink: Sink, features: str, trees: Sequence[SplitTree]) -> str:
    """One ensemble for each tree, (k·n, 1): one ensemble with several targets costs eight times as much."""
    columns = as_columns(sink, features)
    each = [add_steps(sink, columns, [(tree, np.arange(tree.leaves, dtype=np.float32))]) for tree in trees]
    return str(sink.add("Concat", *each, axis=0) if len(each) > 1 else each[0])


def _by_cells(sink: Sink, features: str, cells: Cells, width: int) -> str:
    """Leaf numbers from tables of cells, (k·n,); avoids mispredicted branches.

    `x - threshold` is a product with ones and zeros, so its sign is exact; a steep ramp turns it into 0 or 1.
    """
    count = len(cells.threshold)
    minus = np.zeros((count, width + 1), np.float32)
    minus[np.arange(count), cells.feature] = 1.0
    minus[:, width] = -cells.threshold
    beyond = sink.add("MatMul", sink.constant(minus, tree_names.BEYOND), features)  # (u, n)
    beyond = sink.add("HardSigmoid", beyond, alpha=STEEP, beta=0.0)
    strides = sink.constant(np.ascontiguousarray(cells.strides.T), tree_names.STRIDES)
    cell = sink.add("Gemm", strides, beyond, sink.constant(cells.first[:, None], tree_names.FIRST))  # (k, n)
    number = sink.add("Cast", sink.add("Reshape", cell, sink.constant(np.array([-1]))), to=TensorProto.INT32)
    limits = (sink.constant(np.array(limit, np.int32)) for limit in (0, len(cells.leaf) - 1))
    # NaN may be cast to any cell; the formula gives NaN, too
    number = sink.add("Clip", number, *limits)
    table = sink.constant(cells.leaf.astype(np.uint16), tree_names.LEAF)
    return str(sink.add("GatherElements", table, number, axis=0))
