"""Prediction intervals: a tree of conformal quantiles of the errors that a model makes on unseen episodes.

The leaves are groups of similar actions, and each has quantiles of its own, so that the intervals hold where a model
is sure as well as where it is not (Mondrian conformal prediction, Vovk 2005). Cross-validation corrects them once more,
or the model's own choices do, of which it has learned nothing (split conformal prediction, Papadopoulos 2002).
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
RANDOM, FORMER, OWN = 0, 1, 2  # kinds of episodes: with random arguments, chosen by former models, by this one
MAX_LEAVES = 16
MIN_LEAF = 60  # episodes in a leaf: fewer do not determine a twentieth of them
THIRDS = 3  # of the widths, corrected separately
MIN_PART = 100  # episodes in a third: nine tenths of fewer are known to worse than three points
MIN_OWN = 100  # episodes that the model itself chose: fewer do not correct it
POWERS = tuple(k / 8 for k in range(9))  # of the widths of own choices, from equal widths to those of the leaves
LEAST = 1e-3  # s or J, half of the narrowest interval


@dataclass(frozen=True, slots=True)
class Rows:
    """Errors of a model on episodes that it has not seen, a row each.

    Attributes:
      features: Shape (n, f).
      std: Predicted standard deviations, shape (n,).
      errors: Observed minus predicted values, shape (n,).
    """

    features: Array
    std: Array
    errors: Array

    def and_those_of(self, others: Rows) -> Rows:
        """These rows, then the others."""
        return Rows(
            np.concatenate([self.features, others.features]),
            np.concatenate([self.std, others.std]),
            np.concatenate([self.errors, others.errors]),
        )


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


def fit_intervals(rows: Rows, groups: Numbers, seed: int, kinds: Numbers) -> Intervals:
    """Fit intervals that hold LEVEL of the errors of each kind of episodes, in every third of their widths.

    Args:
      rows: Episodes, each as models predict it that were fitted without it.
      groups: Episode of each row, shape (n,).
      seed: Seed of the folds.
      kinds: Kind of each row, shape (n,): `RANDOM`; `FORMER` if a former model chose it; `OWN`, none or many, if the
        finished model chose it, which has not learned from it. Refinement prefers where a model's spread is too small,
        and former choices do not show where this is so: own ones take their place.
    """
    with_spread, errors = with_std(rows.features, rows.std), rows.errors
    width, excess = np.empty(len(errors)), np.empty(len(errors))
    for apart in held_out_parts(groups, seed):
        splits, lower, upper = _grown(with_spread[~apart], errors[~apart])
        leaf = splits.leaf_of(with_spread[apart])
        width[apart] = upper[leaf] - lower[leaf]
        excess[apart] = np.where(errors[apart] < 0, errors[apart] / lower[leaf], errors[apart] / upper[leaf])
    splits, lower, upper = _grown(with_spread, errors)
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
    own = kinds == OWN
    learned = (kinds == RANDOM,) if own.any() else (np.ones(len(kinds), bool), kinds == RANDOM, kinds == FORMER)
    groups = [group for group in learned if group.sum() >= MIN_LEAF or group.all()]
    corrections = [_by_parts(width[group], excess[group], leaf_width) for group in groups]
    corrections += [_by_power(width[own], excess[own], leaf_width)] if own.any() else []
    needed = np.max(corrections, axis=0)
    return np.where(needed > 0.0, needed, conformal_quantile(excess, LEVEL))


def _by_power(width: Array, excess: Array, leaf_width: Array) -> Array:
    """Correction of each leaf, (l,), by choices of the model itself: a scale and a power of the leaf's width.

    Refinement prefers leaves that came out too narrow, so among its choices the widths differ less than they seem to.
    The power is that with the least mean interval score (Winkler 1972) of the choices.
    """
    usual = np.exp(np.log(width).mean())
    best, least = np.ones(len(leaf_width)), np.inf
    for power in POWERS:
        factor = (width / usual) ** (power - 1)
        scale = conformal_quantile(excess / factor, LEVEL)
        outside = np.maximum(excess - scale * factor, 0) * width / 2
        score = float(np.mean(scale * factor * width + 2 / (1 - LEVEL) * outside))
        if score < least:
            best, least = scale * (leaf_width / usual) ** (power - 1), score
    return best


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
