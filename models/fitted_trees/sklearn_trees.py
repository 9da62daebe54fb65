"""Converts scikit-learn's trees: splits, and the value of each leaf in the order of leaf numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import BaseDecisionTree, DecisionTreeClassifier, DecisionTreeRegressor

from tailor.models.fitted_trees.split_tree import LEAF, SplitTree

Floats = NDArray[np.float32]
Step = tuple[SplitTree, Floats]  # a tree, and a number for each of its leaves: a probability, a risk


def splits_of(grown: BaseDecisionTree) -> SplitTree:
    """Splits of a tree; scikit-learn's double thresholds, rounded down, are exact on single precision rows."""
    tree = grown.tree_
    inner = tree.children_left != LEAF
    threshold = tree.threshold.astype(np.float32)
    threshold = np.where(threshold > tree.threshold, np.nextafter(threshold, np.float32(-np.inf)), threshold)
    return SplitTree(
        np.where(inner, tree.feature, LEAF),
        np.where(inner, threshold, np.float32(0)).astype(np.float32),
        np.where(inner, tree.children_left, 0),
        np.where(inner, tree.children_right, 0),
        np.where(inner, -1, np.cumsum(~inner) - 1),
    )


def shares_of(grown: DecisionTreeClassifier) -> Floats:
    """Weighted share of the second of two classes in each leaf, shape (leaves,); 0 or 1 if only one class was seen."""
    value = grown.tree_.value[grown.tree_.children_left == LEAF, 0, :]
    share = value[:, 1] / value.sum(axis=1) if value.shape[1] == 2 else np.full(len(value), float(grown.classes_[0]))
    shares: Floats = share.astype(np.float32)
    return shares


def means_of(grown: DecisionTreeRegressor) -> Floats:
    """Mean of the targets in each leaf, shape (leaves,)."""
    means: Floats = grown.tree_.value[grown.tree_.children_left == LEAF, 0, 0].astype(np.float32)
    return means
