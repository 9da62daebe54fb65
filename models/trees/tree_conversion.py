"""Converts a grown tree into arrays: formulas in the features' own units, smoothed and clipped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.linear_tree import LeafRow, LinearTree
from tailor.models.fitted_trees.split_tree import LEAF, SplitRow
from tailor.models.trees.scaling import Scale
from tailor.models.trees.tree_induction import Node

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Source:
    """The examples that a tree was grown from, in their own units, and the scale that it was grown in."""

    features: NDArray[np.float32]  # (n, f)
    targets: Array  # (n,) seconds
    weights: Array  # (n,)
    scale: Scale


def to_linear_tree(root: Node, size: int, source: Source, smoothing: float, clip: bool) -> LinearTree:
    """The first `size` splits of a grown tree.

    Args:
      root: Root of the grown tree.
      size: Number of splits to keep, in the order in which they were made.
      source: The examples that it was grown from.
      smoothing: Number of rows that an ancestor's formula counts for.
      clip: Clip each leaf to the range of its training targets.
    """
    nodes: list[SplitRow] = []
    leaves: list[LeafRow] = []

    def visit(node: Node) -> int:
        place = len(nodes)
        nodes.append((LEAF, 0.0, 0, 0, len(leaves)))
        if node.order is None or node.order >= size or node.children is None:
            leaves.append(_leaf(node, source, smoothing, clip))
        else:
            left, right = (visit(child) for child in node.children)
            nodes[place] = (node.feature, node.threshold, left, right, -1)
        return place

    visit(root)
    return LinearTree.of(nodes, leaves)


def _leaf(node: Node, source: Source, smoothing: float, clip: bool) -> LeafRow:
    slopes, intercept = source.scale.raw(_smoothed(node, source.weights, smoothing))
    observed, weights = source.targets[node.rows], source.weights[node.rows]
    low, high = (float(observed.min()), float(observed.max())) if clip else (-np.inf, np.inf)
    off = np.clip(source.features[node.rows] @ slopes + intercept, low, high) - observed
    std = float(np.sqrt(np.average(off**2, weights=weights)))
    return slopes, intercept, low, high, std, len(node.rows)


def _smoothed(node: Node, weights: Array, k: float) -> Array:
    """Quinlan's smoothing folded into the leaf: each ancestor's formula counts as k rows of the node below it."""
    solution, below = node.coefficients, node
    for ancestor in reversed(node.ancestors):
        count = float(weights[below.rows].sum())
        solution = (count * solution + k * ancestor.coefficients) / (count + k)
        below = ancestor
    return solution
