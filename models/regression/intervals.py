"""Prediction intervals: a tree of conformal quantiles of the errors that a model makes on unseen episodes.

The leaves are groups of similar actions, and each has quantiles of its own, so that the intervals hold where a model
is sure as well as where it is not (Mondrian conformal prediction, Vovk 2005). Cross-validation corrects them once more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import DecisionTreeRegressor

from tailor.models.fitted_trees.sklearn_trees import splits_of
from tailor.models.fitted_trees.split_tree import SplitTree
from tailor.models.regression.out_of_fold import held_out_parts

Floats = NDArray[np.float32]
Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

LEVEL = 0.9
MAX_LEAVES = 16
MIN_LEAF = 60  # episodes in a leaf: fewer do not determine a twentieth of them
THIRDS = 3  # of the widths, corrected separately
MIN_PART = 100  # episodes in a third: nine tenths of fewer are known to worse than three points
LEAST = 1e-3  # s or J, half of the narrowest interval


@dataclass(frozen=True, slots=True)
class Intervals:
    """Intervals around predictions, by the leaf of features and of the prediction's standard deviation.

    Attributes:
      splits: Tree over the f features and, as the last one, the standard deviation.
      lower: Added to the mean for the lower end, (l,), negative.
      upper: Added to the mean for the upper end, (l,), positive.
    """

    splits: SplitTree
    lower: Floats
    upper: Floats

    def around(self, features: Floats, mean: Array, std: Array) -> tuple[Array, Array]:
        """Ends of the intervals, shapes (n,), of features (n, f) and predictions (n,)."""
        leaf = self.splits.leaf_of(with_std(features, std))
        return mean + self.lower[leaf], mean + self.upper[leaf]


def with_std(features: NDArray[np.floating], std: NDArray[np.floating]) -> Floats:
    """Features (n, f) and standard deviations (n,) as the columns of the intervals' tree."""
    return np.column_stack([features, std]).astype(np.float32)


def fit_intervals(features: Array, std: Array, errors: Array, groups: Numbers, seed: int, kinds: Numbers) -> Intervals:
    """Fit intervals that hold LEVEL of the errors of each kind of episodes, in every third of their widths.

    Args:
      features: One row per episode, shape (n, f).
      std: Predicted standard deviations of unseen episodes, shape (n,).
      errors: Observed minus predicted values of unseen episodes, shape (n,).
      groups: Episode of each row, shape (n,).
      seed: Seed of the folds.
      kinds: Kind of each row, shape (n,), as random or chosen by the optimiser.
    """
    rows = with_std(features, std)
    width, excess = np.empty(len(errors)), np.empty(len(errors))
    for apart in held_out_parts(groups, seed):
        splits, lower, upper = _grown(rows[~apart], errors[~apart])
        leaf = splits.leaf_of(rows[apart])
        width[apart] = upper[leaf] - lower[leaf]
        excess[apart] = np.where(errors[apart] < 0, errors[apart] / lower[leaf], errors[apart] / upper[leaf])
    splits, lower, upper = _grown(rows, errors)
    factor = _factors(width, excess, kinds, upper - lower)
    return Intervals(splits, (factor * lower).astype(np.float32), (factor * upper).astype(np.float32))


def conformal_quantile(values: Array, level: float) -> float:
    """The value that a fresh one exceeds with probability 1 - level at most, if there are values enough."""
    rank = min(len(values), int(np.ceil((len(values) + 1) * level)))
    return float(np.sort(values)[rank - 1])


def _grown(rows: Floats, errors: Array) -> tuple[SplitTree, Array, Array]:
    """A tree by the size of the errors, and both quantiles in each leaf."""
    tree = DecisionTreeRegressor(max_leaf_nodes=MAX_LEAVES, min_samples_leaf=min(MIN_LEAF, len(errors)), random_state=0)
    splits = splits_of(tree.fit(rows, np.abs(errors)))
    leaf, side = splits.leaf_of(rows), (1 + LEVEL) / 2
    each = [errors[leaf == k] for k in range(splits.leaves)]
    lower = np.array([-max(conformal_quantile(-some, side), LEAST) for some in each])
    upper = np.array([max(conformal_quantile(some, side), LEAST) for some in each])
    return splits, lower, upper


def _factors(width: Array, excess: Array, kinds: Numbers, leaf_width: Array) -> Array:
    """Correction of each leaf, (l,), so that unseen errors are held in each third of the widths.

    Where kinds of episodes differ more than the features tell, the correction is that of the kind that needs most: the
    optimiser's choices are a quarter of the episodes, and what refinement uses. Each kind has thirds of its own, as its
    widths are others: the widest choices would else be judged among random episodes that are as wide.
    """
    of_kinds = [kinds == kind for kind in np.unique(kinds)]
    groups = [np.ones(len(kinds), bool), *(group for group in of_kinds if group.sum() >= MIN_LEAF)]
    needed = np.max([_by_parts(width[group], excess[group], leaf_width) for group in groups], axis=0)
    return np.where(needed > 0.0, needed, conformal_quantile(excess, LEVEL))


def _by_parts(width: Array, excess: Array, leaf_width: Array) -> Array:
    """Correction of each leaf, (l,), by the episodes whose width is in the same third; 0 where all are narrower.

    Few episodes are in halves, or not parted.
    """
    parts = max(1, min(THIRDS, len(width) // MIN_PART))
    edges = np.quantile(width, np.arange(1, parts) / parts)
    part = np.searchsorted(edges, width, "right")
    pooled = conformal_quantile(excess, LEVEL)
    some = [excess[part == k] for k in range(parts)]  # of equal widths a part may hold none
    factors = np.array([conformal_quantile(each, LEVEL) if len(each) else pooled for each in some])
    return np.where(leaf_width <= width.max(), factors[np.searchsorted(edges, leaf_width, "right")], 0.0)
