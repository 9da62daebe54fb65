"""The `linear` variant of the model tree: grown by linear fits, sized on held-out episodes, smoothed, clipped."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.trees.robust_fit import refit
from tailor.models.trees.scaling import Scale
from tailor.models.trees.tree_conversion import Source, to_linear_tree
from tailor.models.trees.tree_induction import Examples, Growth, Node, grow, quantile_bins

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TreeSettings:
    """Settings of both variants of model trees."""

    max_leaves: int = 64
    min_rows: float = 40.0  # weighted rows on each side of a split
    smoothing: float = 0.0  # rows that an ancestor's formula counts for (M5's k)
    ridge: float = 1e-4  # on standardised features
    bins: int = 128  # candidate thresholds per feature
    clip: bool = True  # clip each leaf to the range of its training targets
    huber: float = 0.0  # leaves fitted robustly, see robust_fit.refit; 0: by least squares


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

    Returns:
      The tree, in the units of features and targets.
    """
    scale = Scale.of(features.astype(np.float64), targets)
    z = (features - scale.centre) / scale.width
    y = (targets - scale.y_centre) / scale.y_width
    bins, edges = quantile_bins(features, settings.bins)
    limits = Growth(settings.max_leaves, settings.min_rows, settings.ridge)
    root, splits = grow(Examples.of(z, y, np.where(held_out, 0.0, weights), bins, edges), limits)
    size = len(splits)
    if held_out.any():
        size = _best_size(root, splits, z[held_out], features[held_out], y[held_out])
        if weights[held_out].any():  # the final fit uses the held-out episodes, too
            root, _ = grow(Examples.of(z, y, weights, bins, edges), replace(limits, max_leaves=size + 1))
    if settings.huber > 0:
        _refit_leaves(root, size, z, y, weights, settings)
    source = Source(features, targets, weights, scale)
    return to_linear_tree(root, size, source, smoothing=settings.smoothing, clip=settings.clip)


def _refit_leaves(node: Node, size: int, z: Array, y: Array, weights: Array, settings: TreeSettings) -> None:
    """Fit the leaves of the first `size` splits again, robustly."""
    if node.order is not None and node.order < size and node.children is not None:
        for child in node.children:
            _refit_leaves(child, size, z, y, weights, settings)
        return
    rows, start = node.rows, node.coefficients
    node.coefficients = refit(z[rows], y[rows], weights[rows], start, settings.ridge, settings.huber)


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
