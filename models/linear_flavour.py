"""The `linear` flavour of the model tree: grown by linear fits, sized on held-out episodes, smoothed, clipped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models import moments
from models.growing import Examples, Growth, Node, grow, quantile_bins
from models.linear_tree import LinearTree
from models.split_tree import LEAF

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TreeSettings:
    """What the two flavours of model trees can be told."""

    max_leaves: int = 64
    min_rows: float = 40.0  # weighted rows on each side of a split
    smoothing: float = 0.0  # rows that an ancestor's formula counts for (M5's k)
    ridge: float = 1e-4  # on standardised features
    bins: int = 64  # candidate thresholds per feature
    clip: bool = True  # keep each leaf within what was seen in it


@dataclass(frozen=True, slots=True)
class Scale:
    """Standardisation of features and targets, undone when the tree is written down."""

    centre: Array  # (f,)
    width: Array  # (f,)
    y_centre: float
    y_width: float

    @classmethod
    def of(cls, features: Array, targets: Array) -> Scale:
        """The scale that gives zero mean and unit deviation; constant columns keep their width."""
        width, y_width = features.std(axis=0), float(targets.std())
        return cls(features.mean(axis=0), np.where(width > 1e-12, width, 1.0), float(targets.mean()), y_width or 1.0)

    def raw(self, solution: Array) -> tuple[Array, float]:
        """Slopes and intercept in the features' and the targets' own units."""
        slopes = solution[:-1] / self.width * self.y_width
        return slopes, float(solution[-1] * self.y_width + self.y_centre - slopes @ self.centre)


def fit_linear(
    features: NDArray[np.float32], targets: Array, weights: Array, held_out: NDArray[np.bool_], settings: TreeSettings
) -> LinearTree:
    """Grow on the rows that are not held out, choose the size on those that are, then grow that size on all.

    Args:
      features: Shape (n, f).
      targets: Seconds, shape (n,).
      weights: How often each row counts, shape (n,).
      held_out: Rows that choose the size, shape (n,); without any, the tree grows to `max_leaves`.
      settings: See `TreeSettings`.
    """
    scale = Scale.of(features.astype(np.float64), targets)
    z = (features - scale.centre) / scale.width
    y = (targets - scale.y_centre) / scale.y_width
    bins, edges = quantile_bins(features, settings.bins)
    limits = Growth(settings.max_leaves, settings.min_rows, settings.ridge)
    grown = Examples(z, y, np.where(held_out, 0.0, weights), bins, edges, None)
    root, splits = grow(_with_products(grown), limits)
    size = len(splits)
    if held_out.any():
        size = _best_size(root, splits, z[held_out], features[held_out], y[held_out])
        if weights[held_out].any():  # those episodes are for fitting, too
            grown = Examples(z, y, weights, bins, edges, None)
            root, splits = grow(_with_products(grown), Growth(size + 1, settings.min_rows, settings.ridge))
    return write_down(root, size, features, targets, weights, scale, settings)


def _with_products(e: Examples) -> Examples:
    return Examples(
        e.features, e.targets, e.weights, e.bins, e.edges, moments.row_products(e.features, e.targets, e.weights)
    )


def _best_size(root: Node, splits: list[Node], z: Array, features: NDArray[np.float32], y: Array) -> int:
    """Number of splits with the least absolute error on held-out rows."""
    inside = {id(root): np.arange(len(y))}
    change = []
    for node in splits:
        rows = inside.pop(id(node))
        left = features[rows, node.feature] <= np.float32(node.threshold)
        before = _absolute_error(node, z[rows], y[rows])
        for child, chosen in zip(node.children or (), (rows[left], rows[~left]), strict=True):
            inside[id(child)] = chosen
            before -= _absolute_error(child, z[chosen], y[chosen])
        change.append(-before)
    return int(np.argmin(np.concatenate([[0.0], np.cumsum(change)])))


def _absolute_error(node: Node, z: Array, y: Array) -> float:
    return float(np.abs(z @ node.coefficients[:-1] + node.coefficients[-1] - y).sum())


def write_down(
    root: Node,
    size: int,
    features: NDArray[np.float32],
    targets: Array,
    weights: Array,
    scale: Scale,
    settings: TreeSettings,
) -> LinearTree:
    """The first `size` splits of a grown tree as arrays in the features' own units, smoothed and clipped."""
    nodes: list[tuple[int, float, int, int, int]] = []
    leaves: list[tuple[Array, float, float, float, float, int]] = []

    def visit(node: Node) -> int:
        place = len(nodes)
        nodes.append((LEAF, 0.0, 0, 0, len(leaves)))
        if node.order is None or node.order >= size or node.children is None:
            leaves.append(_leaf(node, features, targets, weights, scale, settings))
        else:
            left, right = (visit(child) for child in node.children)
            nodes[place] = (node.feature, node.threshold, left, right, -1)
        return place

    visit(root)
    return LinearTree.of(nodes, leaves)


def _leaf(
    node: Node,
    features: NDArray[np.float32],
    targets: Array,
    weights: Array,
    scale: Scale,
    settings: TreeSettings,
) -> tuple[Array, float, float, float, float, int]:
    slopes, intercept = scale.raw(_smoothed(node, weights, settings.smoothing))
    seen = targets[node.rows]
    low, high = (float(seen.min()), float(seen.max())) if settings.clip else (-np.inf, np.inf)
    off = np.clip(features[node.rows] @ slopes + intercept, low, high) - seen
    spread = float(np.sqrt(np.average(off**2, weights=weights[node.rows])))
    return slopes, intercept, low, high, spread, len(node.rows)


def _smoothed(node: Node, weights: Array, k: float) -> Array:
    """Quinlan's smoothing folded into the leaf: each ancestor's formula counts as k rows of the node below it."""
    solution, below = node.coefficients, node
    for ancestor in reversed(node.ancestors):
        count = float(weights[below.rows].sum())
        solution = (count * solution + k * ancestor.coefficients) / (count + k)
        below = ancestor
    return solution
