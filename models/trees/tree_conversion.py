"""Writes a grown tree down: arrays in the features' own units, formulas smoothed and clipped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.trees.linear_tree import LeafRow, LinearTree
from tailor.models.trees.scaling import Scale
from tailor.models.trees.split_tree import LEAF, SplitRow
from tailor.models.trees.tree_induction import Node

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Source:
    """What a tree was grown from, in its own units, and the scale that it was grown in."""

    features: NDArray[np.float32]  # (n, f)
    targets: Array  # (n,) seconds
    weights: Array  # (n,)
    scale: Scale


def write_down(root: Node, size: int, source: Source, smoothing: float, clip: bool) -> LinearTree:
    """The first `size` splits of a grown tree.

    Args:
      root: Of the grown tree.
      size: Splits to keep, in the order in which they were made.
      source: What it was grown from.
      smoothing: Rows that an ancestor's formula counts for.
      clip: Keep each leaf within what was seen in it.
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
    seen, weights = source.targets[node.rows], source.weights[node.rows]
    low, high = (float(seen.min()), float(seen.max())) if clip else (-np.inf, np.inf)
    off = np.clip(source.features[node.rows] @ slopes + intercept, low, high) - seen
    spread = float(np.sqrt(np.average(off**2, weights=weights)))
    return slopes, intercept, low, high, spread, len(node.rows)


def _smoothed(node: Node, weights: Array, k: float) -> Array:
    """Quinlan's smoothing folded into the leaf: each ancestor's formula counts as k rows of the node below it."""
    solution, below = node.coefficients, node
    for ancestor in reversed(node.ancestors):
        count = float(weights[below.rows].sum())
        solution = (count * solution + k * ancestor.coefficients) / (count + k)
        below = ancestor
    return solution
