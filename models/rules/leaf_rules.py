"""Rules of the very trees inside an ONNX model, and what each of them says by itself."""

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
    """The leaves of a tree, counted from 1.

    Raises:
      UsageError: There is no such tree.
    """
    count = len(boxes.first)
    if not 1 <= number <= count:
        raise UsageError(f"there is no tree {number} (the model has {count}, expected 1 to {count})")
    ends = [*boxes.first[1:].tolist(), len(boxes.low)]
    return range(int(boxes.first[number - 1]), ends[number - 1])


def rules_of(boxes: TreeBoxes, number: int, quantities: Sequence[Quantity], unit: str) -> list[str]:
    """One rule a leaf of a tree; `unit` is that of its formulas, "" where leaves say a probability of success."""
    said = []
    for leaf in leaves_of(boxes, number):
        box = LeafBox(leaf, boxes.lower[leaf].astype(np.float64), boxes.upper[leaf].astype(np.float64))
        then = f"success in {100 * boxes.low[leaf]:.0f} %"
        if unit:
            then = f"{QUANTITY_NAMES[unit]} = {formula(boxes, leaf, quantities, unit)}"
        said.append(f"if {conditions(box, quantities)}\nthen {then}")
    return said


def applied_rule(boxes: TreeBoxes, features: Floats, quantities: Sequence[Quantity], unit: str) -> str:
    """Rule that applies to one row of features, shape (f,), from the tree closest to the mean of all trees.

    Empty where a feature is not a number, or in no leaf.
    """
    inside = ((features > boxes.lower) & (features <= boxes.upper)).all(axis=1)
    leaves = np.flatnonzero(inside)
    if len(leaves) != len(boxes.first):
        return ""
    said = np.clip(boxes.slopes[leaves] @ features + boxes.intercept[leaves], boxes.low[leaves], boxes.high[leaves])
    tree = int(np.abs(said - said.mean()).argmin())
    leaf = int(leaves[tree])
    box = LeafBox(leaf, boxes.lower[leaf].astype(np.float64), boxes.upper[leaf].astype(np.float64))
    of = "" if len(leaves) == 1 else f" (tree {tree + 1} of {len(leaves)}, the one that says nearest to their mean)"
    return (
        f"if {conditions(box, quantities)} then {QUANTITY_NAMES[unit]} = {formula(boxes, leaf, quantities, unit)}{of}"
    )


def predictions_of(boxes: TreeBoxes, number: int, features: Floats) -> Floats:
    """What a tree says of features (n, f), shape (n,)."""
    answers = np.full(len(features), np.nan, np.float32)
    for leaf in leaves_of(boxes, number):
        inside = ((features > boxes.lower[leaf]) & (features <= boxes.upper[leaf])).all(axis=1)
        value = features[inside] @ boxes.slopes[leaf] + boxes.intercept[leaf]
        answers[inside] = np.clip(value, boxes.low[leaf], boxes.high[leaf])
    return answers
