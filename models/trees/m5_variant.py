"""The `m5` variant of the model tree: M5' of Quinlan (1992) and Wang & Witten (1997), the paper's learner.

Splits by standard deviation reduction; formulas of the attributes tested below; attributes and subtrees dropped by the
estimate error·(n + v)/(n - v); smoothing with k = 15.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.fitted_trees.split_tree import LEAF
from tailor.models.trees import moments
from tailor.models.trees.scaling import Scale

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

MIN_ROWS = 4  # M5': a node with fewer is a leaf
STOP_SHARE = 0.05  # of the whole deviation: a purer node is a leaf
SMOOTHING = 15.0  # Quinlan's k
RIDGE = 1e-8


@dataclass(slots=True)
class _Node:
    rows: Rows
    used: frozenset[int]  # attributes tested at or below this node
    solution: Array  # (f + 1,)
    estimate: float  # estimated absolute error of the formula or of the subtree
    feature: int = -1
    threshold: float = 0.0
    children: tuple[_Node, _Node] | None = None


def fit_m5(features: NDArray[np.float32], targets: Array, clip: bool) -> LinearTree:
    """Fit M5' to examples.

    Args:
      features: Shape (n, f).
      targets: Seconds, shape (n,).
      clip: Clip each leaf to the range of its training targets.

    Returns:
      The tree, in the units of features and targets.
    """
    scale = Scale.of(features.astype(np.float64), targets)
    z, y = (features - scale.centre) / scale.width, (targets - scale.y_centre) / scale.y_width
    root = _grow(features, z, y, np.arange(len(y)))
    return _write_down(root, features, targets, scale, clip)


def _grow(features: NDArray[np.float32], z: Array, y: Array, rows: Rows) -> _Node:
    """Grow a subtree and fit its formula; prune the subtree if the formula alone has the lower estimated error."""
    split = _best_split(features[rows], y[rows]) if len(rows) >= 2 * MIN_ROWS and y[rows].std() >= STOP_SHARE else None
    if split is None:
        solution, estimate = _formula(z, y, rows, frozenset())
        return _Node(rows, frozenset(), solution, estimate)
    feature, threshold = split
    left = features[rows, feature] <= np.float32(threshold)
    pair = _grow(features, z, y, rows[left]), _grow(features, z, y, rows[~left])
    used = pair[0].used | pair[1].used | {feature}
    solution, estimate = _formula(z, y, rows, used)
    below = sum(len(child.rows) * child.estimate for child in pair) / len(rows)
    if estimate <= below:
        return _Node(rows, used, solution, estimate)
    return _Node(rows, used, solution, below, feature, threshold, pair)


def _best_split(x: NDArray[np.float32], y: Array) -> tuple[int, float] | None:
    """Feature and threshold with the largest reduction of the standard deviation, None if there is no reduction."""
    count, best, chosen = len(y), 1e-12, None
    order = np.argsort(x, axis=0, kind="stable")
    size = np.arange(1, count)
    for feature in range(x.shape[1]):
        column, target = x[order[:, feature], feature], y[order[:, feature]]
        first, square = np.cumsum(target)[:-1], np.cumsum(target**2)[:-1]
        all_first, all_square = first[-1] + target[-1], square[-1] + target[-1] ** 2
        left = np.sqrt(np.maximum(square * size - first**2, 0))  # n·deviation
        rest = count - size
        right = np.sqrt(np.maximum((all_square - square) * rest - (all_first - first) ** 2, 0))
        gain = y.std() - (left + right) / count
        gain[(column[1:] <= column[:-1]) | (size < MIN_ROWS // 2) | (rest < MIN_ROWS // 2)] = -1
        at = int(np.argmax(gain))
        if gain[at] > best:
            best, chosen = float(gain[at]), (feature, float(column[at]))
    return chosen


def _formula(z: Array, y: Array, rows: Rows, used: frozenset[int]) -> tuple[Array, float]:
    """A linear formula of the used attributes; those whose absence lowers the estimated error are dropped greedily."""
    kept, best = sorted(used), None
    while True:
        solution, estimate = _fit(z, y, rows, kept)
        if best is None or estimate <= best[1]:
            best = solution, estimate
        if not kept:
            return best
        trials = [_fit(z, y, rows, [k for k in kept if k != gone]) for gone in kept]
        least = int(np.argmin([trial[1] for trial in trials]))
        if trials[least][1] > best[1]:
            return best
        kept = [k for k in kept if k != kept[least]]


def _fit(z: Array, y: Array, rows: Rows, kept: list[int]) -> tuple[Array, float]:
    part = z[np.ix_(rows, np.array(kept, np.intp))]
    full = moments.unpack(moments.row_products(part, y[rows], np.ones(len(rows))).sum(axis=0), len(kept))
    solution = moments.fit(full, RIDGE)[0]
    error = float(np.abs(part @ solution[:-1] + solution[-1] - y[rows]).mean())
    size, parameters = len(rows), len(kept) + 1
    estimate = error * (size + parameters) / (size - parameters) if size > parameters else 10 * error + 1.0
    wide = np.zeros(z.shape[1] + 1)
    wide[[*kept, -1]] = solution
    return wide, estimate


def _write_down(root: _Node, features: NDArray[np.float32], targets: Array, scale: Scale, clip: bool) -> LinearTree:
    nodes: list[tuple[int, float, int, int, int]] = []
    leaves: list[tuple[Array, float, float, float, float, int]] = []

    def visit(node: _Node, path: tuple[_Node, ...]) -> int:
        place = len(nodes)
        nodes.append((LEAF, 0.0, 0, 0, len(leaves)))
        if node.children is None:
            slopes, intercept = scale.raw(_smoothed(node, path))
            observed = targets[node.rows]
            low, high = (float(observed.min()), float(observed.max())) if clip else (-np.inf, np.inf)
            std = float((np.clip(features[node.rows] @ slopes + intercept, low, high) - observed).std())
            leaves.append((slopes, intercept, low, high, std, len(node.rows)))
        else:
            left, right = (visit(child, (*path, node)) for child in node.children)
            nodes[place] = (node.feature, node.threshold, left, right, -1)
        return place

    visit(root, ())
    return LinearTree.of(nodes, leaves)


def _smoothed(node: _Node, path: tuple[_Node, ...]) -> Array:
    solution, below = node.solution, node
    for ancestor in reversed(path):
        count = len(below.rows)
        solution = (count * solution + SMOOTHING * ancestor.solution) / (count + SMOOTHING)
        below = ancestor
    return solution
