"""Induction of model trees, best first: each split minimises the error of linear fits on both sides."""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tailor.models.trees import moments

Array = NDArray[np.float64]


@dataclass(slots=True)
class Node:
    """A node of a growing tree; `order` counts the splits (0 first) and is None for a leaf."""

    rows: NDArray[np.intp]
    coefficients: Array  # (f + 1,) of standardised features and targets
    error: float  # sum of squared errors
    depth: int
    feature: int = -1
    threshold: float = 0.0
    gain: float = 0.0
    order: int | None = None
    children: tuple[Node, Node] | None = None
    ancestors: tuple[Node, ...] = field(default=(), repr=False)


@dataclass(frozen=True, slots=True)
class Examples:
    """Standardised examples with their bins: the input of induction."""

    features: Array  # (n, f)
    targets: Array  # (n,)
    weights: Array  # (n,), 0 leaves a row out
    bins: NDArray[np.uint8]  # (n, f)
    edges: tuple[NDArray[np.float32], ...]  # per feature: thresholds in the feature's own units
    products: Array  # (n, q) packed moments of each row, weighted

    @classmethod
    def of(
        cls,
        features: Array,
        targets: Array,
        weights: Array,
        bins: NDArray[np.uint8],
        edges: tuple[NDArray[np.float32], ...],
    ) -> Examples:
        """Examples with the moments of each row."""
        return cls(features, targets, weights, bins, edges, moments.row_products(features, targets, weights))


def quantile_bins(
    features: NDArray[np.float32], count: int
) -> tuple[NDArray[np.uint8], tuple[NDArray[np.float32], ...]]:
    """Bins of about equal population; edge i separates bin i (values <= edge) from bin i + 1."""
    edges, bins = [], np.empty(features.shape, np.uint8)
    for k, column in enumerate(features.T):
        cuts = np.unique(np.quantile(column, np.linspace(0, 1, count + 1)[1:-1], method="lower"))
        edges.append(cuts[cuts < column.max()])
        bins[:, k] = np.searchsorted(edges[-1], column, side="left")
    return bins, tuple(edges)


@dataclass(frozen=True, slots=True)
class Growth:
    """Limits of the growth of a tree."""

    max_leaves: int
    min_rows: float  # weighted rows on each side of a split
    ridge: float


def grow(examples: Examples, limits: Growth) -> tuple[Node, list[Node]]:
    """Grow a tree.

    Returns:
      The root, and the split nodes in the order of their splits.
    """
    rows = np.flatnonzero(examples.weights > 0)
    root = _node(examples, rows, limits, ())
    queue, made, ticket = [(-root.gain, 0, root)], list[Node](), 1
    while queue and len(made) < limits.max_leaves - 1:
        _, _, node = heapq.heappop(queue)
        if node.gain <= 0.0:
            break
        node.order = len(made)
        made.append(node)
        left = examples.bins[node.rows, node.feature] <= np.searchsorted(examples.edges[node.feature], node.threshold)
        pair = []
        for side in (node.rows[left], node.rows[~left]):
            pair.append(_node(examples, side, limits, (*node.ancestors, node)))
            heapq.heappush(queue, (-pair[-1].gain, ticket, pair[-1]))
            ticket += 1
        node.children = (pair[0], pair[1])
    return root, made


def _node(examples: Examples, rows: NDArray[np.intp], limits: Growth, ancestors: tuple[Node, ...]) -> Node:
    count = examples.features.shape[1]
    products = examples.products[rows]
    total = products.sum(axis=0)
    solution, error = moments.fit(moments.unpack(total, count), limits.ridge)
    node = Node(rows, solution, float(error), len(ancestors), ancestors=ancestors)
    if len(rows) >= 2 * limits.min_rows:
        _choose_split(node, examples, products, total, limits)
    return node


def _choose_split(node: Node, examples: Examples, products: Array, total: Array, limits: Growth) -> None:
    """Set the node's best split, if any reduces the error."""
    count = examples.features.shape[1]
    one = products.shape[1] - 3  # packed place of 1·1: the third from the end
    for feature in range(count):
        edges = examples.edges[feature]
        if not len(edges):
            continue
        left = _running_sums(examples.bins[node.rows, feature], products, len(edges))
        allowed = (left[:, one] >= limits.min_rows) & (total[one] - left[:, one] >= limits.min_rows)
        if not allowed.any():
            continue
        sides = moments.unpack(np.stack([left[allowed], total - left[allowed]]), count)
        errors = moments.fit(sides, limits.ridge)[1].sum(axis=0)
        best = int(np.argmin(errors))
        gain = node.error - float(errors[best])
        if gain > max(node.gain, 1e-9 * total[-1]):
            node.feature, node.gain = feature, gain
            node.threshold = float(edges[np.flatnonzero(allowed)[best]])


def _running_sums(bins: NDArray[np.uint8], products: Array, edges: int) -> Array:
    """Moments of all rows up to each edge, shape (edges, q)."""
    sums = np.stack([np.bincount(bins, column, minlength=edges + 1)[:edges] for column in products.T], axis=1)
    return np.cumsum(sums, axis=0)
