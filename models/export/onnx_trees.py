"""Adds fitted trees to ONNX graphs; results equal those in numpy bit for bit, except for the order of sums."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tailor.models.export.onnx_graph import Sink, single
from tailor.models.export.onnx_leaves import add_leaves, add_steps
from tailor.models.fitted_trees import tree_names
from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.fitted_trees.split_tree import SplitTree

Tables = NDArray[np.float32]


def add_probability(sink: Sink, features: str, steps: Sequence[tuple[SplitTree, NDArray[np.float32]]]) -> str:
    """The mean of trees with a probability in each leaf: features (n, f) to (n,)."""
    parts = [(tree, values / np.float32(len(steps))) for tree, values in steps]
    return _flat(sink, add_steps(sink, features, parts))


def add_tree(sink: Sink, features: str, tree: LinearTree) -> tuple[str, str]:
    """One model tree: mean and standard deviation, shapes (n,), of rows of features (f, n).

    Every leaf's formula is computed in one product, and the one of the row's leaf is selected.
    """
    rows, width = _with_one(sink, features), tree.slopes.shape[1]
    leaf = add_leaves(sink, rows, [tree.splits], width)
    formulas = np.column_stack([tree.slopes, tree.intercept])
    every = sink.add("MatMul", sink.constant(formulas, tree_names.FORMULAS), rows)  # (l, n)
    ends = {tree_names.LOW: tree.low[None], tree_names.HIGH: tree.high[None]}
    mean = _clipped(sink, sink.add("GatherElements", every, leaf, axis=0), leaf, ends)
    return _flat(sink, mean), _flat(sink, _looked_up(sink, tree_names.LEAF_STD, tree.std[None], leaf))


def add_bag(sink: Sink, features: str, trees: Sequence[LinearTree]) -> tuple[str, str]:
    """A bag of k model trees: mean and standard deviation over the trees, shapes (n,), of rows of features (f, n)."""
    width = trees[0].slopes.shape[1]
    leaf = add_leaves(sink, _with_one(sink, features), [tree.splits for tree in trees], width)
    each = _formulas(sink, features, leaf, trees)  # (k, n)
    share = sink.constant(np.full(len(trees), 1 / len(trees), np.float32))
    mean = str(sink.add("MatMul", share, each))
    off = sink.add("Sub", each, mean)
    return mean, str(sink.add("Sqrt", sink.add("MatMul", share, sink.add("Mul", off, off))))


def _formulas(sink: Sink, features: str, leaf: str, trees: Sequence[LinearTree]) -> str:
    """clip(slopes · features + intercept, low, high) of leaves (k, n): seconds (k, n). One table for each term."""
    tables = [_table([tree.slopes[:, j] for tree in trees]) for j in range(trees[0].slopes.shape[1])]
    total = _looked_up(sink, tree_names.TERM.format(len(tables)), _table([tree.intercept for tree in trees]), leaf)
    for j, table in enumerate(tables):
        slope = _looked_up(sink, tree_names.TERM.format(j), table, leaf)
        row = sink.add("Gather", features, sink.constant(np.array([j])), axis=0)
        total = sink.add("Add", total, sink.add("Mul", slope, row))
    ends = {
        tree_names.LOW: _table([tree.low for tree in trees]),
        tree_names.HIGH: _table([tree.high for tree in trees]),
    }
    return _clipped(sink, total, leaf, ends)


def _table(each: Sequence[NDArray[np.float32]]) -> Tables:
    """One row per tree, padded to the largest number of leaves."""
    table = np.zeros((len(each), max(map(len, each))), np.float32)
    for row, values in zip(table, each, strict=True):
        row[: len(values)] = values
    return table


def _looked_up(sink: Sink, name: str, table: Tables, leaf: str) -> str:
    """Each tree's number for its leaf, (k, n). GatherElements takes an eighth of Gather's time here."""
    return str(sink.add("GatherElements", sink.constant(table, name), leaf, axis=1))


def _clipped(sink: Sink, values: str, leaf: str, ends: dict[str, Tables]) -> str:
    low, high = (_looked_up(sink, name, table, leaf) for name, table in ends.items())
    return str(sink.add("Min", sink.add("Max", values, low), high))


def _with_one(sink: Sink, features: str) -> str:
    """Rows of features with a row of ones below, for the constant terms of products: (f + 1, n)."""
    return str(sink.add("Pad", features, sink.constant(np.array([0, 0, 1, 0])), sink.constant(single(1.0))))


def _flat(sink: Sink, values: str) -> str:
    return str(sink.add("Reshape", values, sink.constant(np.array([-1]))))
