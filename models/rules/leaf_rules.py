"""Rules and predictions of single trees inside an ONNX model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.tree_boxes import TreeBoxes
from tailor.models.features.features import Quantity
from tailor.models.rules.rule_text import QUANTITY_NAMES, LeafBox, conditions, formula
from tailor.schemas.errors import UsageError

Floats = NDArray[np.float32]


def leaves_of(boxes: TreeBoxes, number: int) -> range:
    """Leaves of a tree; trees are numbered from 1.

    Raises:
      UsageError: There is no such tree.
    """
    count = len(boxes.first)
    if not 1 <= number <= count:
        raise UsageError(f"there is no tree {number} (the model has {count}, expected 1 to {count})")
    ends = [*boxes.first[1:].tolist(), len(boxes.low)]
    return range(int(boxes.first[number - 1]), ends[number - 1])


def rules_of(boxes: TreeBoxes, number: int, quantities: Sequence[Quantity], unit: str) -> list[str]:
    """One rule per leaf of a tree; `unit` is that of its formulas, "" where leaves hold a probability of success."""
    rules = []
    for leaf in leaves_of(boxes, number):
        box = LeafBox(leaf, boxes.lower[leaf].astype(np.float64), boxes.upper[leaf].astype(np.float64))
        then = f"success in {100 * boxes.low[leaf]:.0f} %"
        if unit:
            then = f"{QUANTITY_NAMES[unit]} = {formula(boxes, leaf, quantities, unit)}"
        rules.append(f"if {conditions(box, quantities)}\nthen {then}")
    return rules


def applied_rule(boxes: TreeBoxes, features: Floats, quantities: Sequence[Quantity], unit: str) -> str:
    """Rule that applies to one row of features, shape (f,), from the tree closest to the mean of all trees.

    Empty if a feature is not a number.
    """
    inside = ((features > boxes.lower) & (features <= boxes.upper)).all(axis=1)
    leaves = np.flatnonzero(inside)
    if len(leaves) != len(boxes.first):
        return ""
    each = np.clip(boxes.slopes[leaves] @ features + boxes.intercept[leaves], boxes.low[leaves], boxes.high[leaves])
    tree = int(np.abs(each - each.mean()).argmin())
    leaf = int(leaves[tree])
    box = LeafBox(leaf, boxes.lower[leaf].astype(np.float64), boxes.upper[leaf].astype(np.float64))
    of = "" if len(leaves) == 1 else f" (tree {tree + 1} of {len(leaves)}, the one closest to their mean)"
    return (
        f"if {conditions(box, quantities)} then {QUANTITY_NAMES[unit]} = {formula(boxes, leaf, quantities, unit)}{of}"
    )


def predictions_of(boxes: TreeBoxes, number: int, features: Floats) -> Floats:
    """Predictions of a tree, shape (n,), of features (n, f).

    Raises:
      UsageError: There is no such tree.
    """
    predictions = np.full(len(features), np.nan, np.float32)
    for leaf in leaves_of(boxes, number):
        inside = ((features > boxes.lower[leaf]) & (features <= boxes.upper[leaf])).all(axis=1)
        with np.errstate(invalid="ignore"):  # BLAS computes with its padding too, and may raise the flag for that
            value = features[inside] @ boxes.slopes[leaf] + boxes.intercept[leaf]
        predictions[inside] = np.clip(value, boxes.low[leaf], boxes.high[leaf])
    return predictions
