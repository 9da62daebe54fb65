"""The trees of an ONNX action model as boxes of features: the input of bounds and rules.

They are read from the same bytes that the runtime loads, so that the two cannot differ.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.cell_boxes import boxes_of_cells
from tailor.models.bounds.onnx_reader import Contents, Node, read_graph
from tailor.models.fitted_trees import tree_names

Floats = NDArray[np.float32]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class TreeBoxes:
    """k trees with l leaves in all, over f features; the model predicts the mean over its trees.

    Leaf i holds the rows with `lower[i] < x <= upper[i]` and predicts `x @ slopes[i] + intercept[i]`, clipped to
    `low[i]` and `high[i]`.
    """

    first: Ints  # (k,) the first leaf of each tree; the leaves of a tree are contiguous
    lower: Floats  # (l, f), -inf where there is no bound
    upper: Floats  # (l, f)
    slopes: Floats  # (l, f), all zero where a leaf predicts a constant
    intercept: Floats  # (l,)
    low: Floats  # (l,)
    high: Floats  # (l,)
    std: Floats | None = None  # (l,) standard deviation by leaf; None: that over the trees

    def part(self, leaves: NDArray[np.bool_]) -> TreeBoxes:
        """The trees with a selection of their leaves, (l,): at least one of each tree."""
        counts = np.add.reduceat(leaves, self.first, dtype=np.int64)
        return replace(
            self,
            first=np.cumsum(counts) - counts,
            lower=self.lower[leaves],
            upper=self.upper[leaves],
            slopes=self.slopes[leaves],
            intercept=self.intercept[leaves],
            low=self.low[leaves],
            high=self.high[leaves],
            std=None if self.std is None else self.std[leaves],
        )

    def inside(self, lowest: NDArray[np.float64], highest: NDArray[np.float64]) -> TreeBoxes:
        """The trees for features between these, (f,): sides beyond them become infinite, since they decide nothing."""
        lower = np.where(self.lower < lowest, np.float32(-np.inf), self.lower)
        upper = np.where(self.upper > highest, np.float32(np.inf), self.upper)
        return replace(self, lower=lower, upper=upper)


def tree_boxes(model: bytes, features: int) -> TreeBoxes | None:
    """Trees of an ONNX model over `features` features; None if it is not of the form that the export writes."""
    try:
        return trees_of_graph(read_graph(model), features)
    except (ValueError, KeyError, IndexError):
        return None


def trees_of_graph(graph: Contents, features: int, blended: bool = False) -> TreeBoxes | None:
    """The same of a graph that has been read.

    Trees that are blended with networks do not predict alone what the model does: only if `blended` are they returned.
    """
    try:
        if not blended and any(node.op == "Relu" for node in graph.nodes):
            return None
        trees = [node for node in graph.nodes if node.op == "TreeEnsembleRegressor"]
        ensembles = [node for node in trees if node.name != tree_names.INTERVALS]
        boxes = _boxes(ensembles, features) if ensembles else boxes_of_cells(graph, features)
        return _linear(graph, *boxes) if tree_names.LOW in graph.constants else _plain(graph, *boxes)
    except (ValueError, KeyError, IndexError):
        return None


def _plain(graph: Contents, first: Ints, lower: Floats, upper: Floats, numbers: Floats) -> TreeBoxes | None:
    """Leaves that predict a constant; the graph sums the trees."""
    last = [node.op for node in graph.nodes[-2:]]
    if last != ["TreeEnsembleRegressor", "Reshape"]:
        return None  # an unknown operation on the sum
    value = numbers * np.float32(len(first))
    return TreeBoxes(first, lower, upper, np.zeros_like(lower), value, value, value)


def _linear(graph: Contents, first: Ints, lower: Floats, upper: Floats, numbers: Floats) -> TreeBoxes:
    """Leaves with a formula, which the constants hold by the leaf's number in its tree."""
    tree = np.repeat(np.arange(len(first)), np.diff([*first, len(numbers)]))
    place = tree, numbers.astype(np.int64)
    formula = _formulas(graph, lower.shape[1])[place]
    low, high = (graph.constants[name][place] for name in (tree_names.LOW, tree_names.HIGH))
    leaf_std = graph.constants.get(tree_names.LEAF_STD)
    std = None if leaf_std is None else leaf_std[place]
    return TreeBoxes(first, lower, upper, formula[:, :-1], formula[:, -1], low, high, std)


def _formulas(graph: Contents, features: int) -> Floats:
    """Slopes and intercept of each leaf of each tree, (k, m, f + 1)."""
    if tree_names.FORMULAS in graph.constants:
        return np.asarray(graph.constants[tree_names.FORMULAS])[None]
    return np.stack([graph.constants[tree_names.TERM.format(j)] for j in range(features + 1)], axis=2)


def _boxes(ensembles: list[Node], features: int) -> tuple[Ints, Floats, Floats, Floats]:
    """First leaf of each tree, box of each leaf, and the value of each leaf."""
    first: list[int] = []
    parts: list[tuple[Floats, Floats, Floats]] = []
    count = 0
    for node in ensembles:
        trees = node.attributes["nodes_treeids"]
        for tree in sorted(set(trees.tolist())):  # np.unique loads numpy.ma, 40 ms
            part = _tree(node.attributes, trees == tree, node.attributes["target_treeids"] == tree, features)
            first.append(count)
            count += len(part[2])
            parts.append(part)
    lower, upper, values = (np.concatenate(column) for column in zip(*parts, strict=True))
    return np.array(first), lower, upper, values


def boxes_of_node(node: Node, features: int) -> tuple[Floats, Floats, Floats]:
    """Boxes and numbers of the leaves of a tree that is alone in its node."""
    every = np.ones(len(node.attributes["nodes_treeids"]), bool)
    return _tree(node.attributes, every, np.ones(len(node.attributes["target_treeids"]), bool), features)


def _tree(
    attributes: dict[str, NDArray[Any]], nodes: NDArray[np.bool_], leaves: NDArray[np.bool_], features: int
) -> tuple[Floats, Floats, Floats]:
    """Boxes and numbers of one tree's leaves, by following each node's box to its two children."""
    names = ("featureids", "values", "truenodeids", "falsenodeids")
    feature, value, true, false = (attributes[f"nodes_{name}"][nodes] for name in names)
    leaf = attributes["target_nodeids"][leaves]
    lower = np.full((len(value), features), -np.inf, np.float32)
    upper = np.full((len(value), features), np.inf, np.float32)
    ends = set(leaf.tolist())
    for node in range(len(value)):  # parents come before their children
        if node in ends:
            continue
        left, right, column = true[node], false[node], feature[node]
        if min(left, right) <= node:
            raise ValueError("a node comes before its parent")
        for child in (left, right):
            lower[child], upper[child] = lower[node], upper[node]
        upper[left, column] = min(upper[left, column], value[node])
        lower[right, column] = max(lower[right, column], value[node])
    return lower[leaf], upper[leaf], attributes["target_weights"][leaves]
