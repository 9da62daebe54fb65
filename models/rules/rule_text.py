"""Prints trees as rules like Figure 7 of the paper: conditions, then the formula, with units."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.models.features.features import Quantity
from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.fitted_trees.split_tree import LEAF, SplitTree

Floats = NDArray[np.float32]

DEGREES = 180 / np.pi
TOO_SMALL = 0.0005  # seconds (joules) per unit; smaller slopes are left out
UNITLESS = ("", "1")  # units that are not printed
QUANTITY_NAMES = {"s": "time", "J": "energy"}  # of what a formula gives, by its unit


class LeafFormulas(Protocol):
    """Formulas of l leaves over f features; `LinearTree` and `TreeBoxes` have them."""

    @property
    def slopes(self) -> Floats:
        """Slopes, shape (l, f)."""

    @property
    def intercept(self) -> Floats:
        """Intercepts, shape (l,)."""

    @property
    def low(self) -> Floats:
        """Lower ends of the predictions, shape (l,)."""

    @property
    def high(self) -> Floats:
        """Upper ends of the predictions, shape (l,)."""

    @property
    def std(self) -> Floats | None:
        """Standard deviations, shape (l,), None where leaves have none."""


@dataclass(frozen=True, slots=True)
class LeafBox:
    """Conditions on the path to a leaf, for each feature: lower < value <= upper."""

    leaf: int
    lower: NDArray[np.float64]  # (f,)
    upper: NDArray[np.float64]  # (f,)


def leaf_boxes(tree: SplitTree, features: int) -> Iterator[LeafBox]:
    """The box of every leaf, from left to right."""

    def visit(node: int, lower: NDArray[np.float64], upper: NDArray[np.float64]) -> Iterator[LeafBox]:
        feature, threshold = int(tree.feature[node]), float(tree.threshold[node])
        if feature == LEAF:
            yield LeafBox(int(tree.leaf[node]), lower, upper)
            return
        left, right = upper.copy(), lower.copy()
        left[feature], right[feature] = min(upper[feature], threshold), max(lower[feature], threshold)
        yield from visit(int(tree.left[node]), lower, left)
        yield from visit(int(tree.right[node]), right, upper)

    yield from visit(0, np.full(features, -np.inf), np.full(features, np.inf))


def duration_rules(tree: LinearTree, quantities: Sequence[Quantity], unit: str = "s") -> list[str]:
    """One rule per leaf: "if ... then time = ...", or "energy" where the unit is J."""
    return [
        f"if {conditions(box, quantities)}\nthen {QUANTITY_NAMES[unit]} = {formula(tree, box.leaf, quantities, unit)}"
        for box in leaf_boxes(tree.splits, len(quantities))
    ]


def success_rules(splits: SplitTree, success: NDArray[np.float32], quantities: Sequence[Quantity]) -> list[str]:
    """One rule per leaf: "if ... then success in p %"."""
    return [
        f"if {conditions(box, quantities)}\nthen success in {100 * success[box.leaf]:.0f} %"
        for box in leaf_boxes(splits, len(quantities))
    ]


def conditions(box: LeafBox, quantities: Sequence[Quantity]) -> str:
    """The conditions of a leaf, angles in degrees."""
    parts = []
    for quantity, low, high in zip(quantities, box.lower, box.upper, strict=True):
        below, above = np.isfinite(high), np.isfinite(low)
        if below and above:
            parts.append(f"{_value(low, quantity)} < {quantity.name} <= {_value(high, quantity)}")
        elif below:
            parts.append(f"{quantity.name} <= {_value(high, quantity)}")
        elif above:
            parts.append(f"{quantity.name} > {_value(low, quantity)}")
    return " and ".join(parts) or "in all cases"


def formula(tree: LeafFormulas, leaf: int, quantities: Sequence[Quantity], of: str = "s") -> str:
    """Linear formula of a leaf in its unit, slopes of angles per degree, and the range that it is clipped to."""
    terms = []
    for quantity, slope in zip(quantities, tree.slopes[leaf].tolist(), strict=True):
        if abs(slope) >= TOO_SMALL:
            shown = slope / DEGREES if quantity.unit == "rad" else slope
            sign = "-" if shown < 0 else "+"
            terms.append(f" {sign} {abs(shown):.3g} {_per(of, quantity)} · {quantity.name}")
    start = f"{tree.intercept[leaf]:.3g} {of}{''.join(terms)}"
    deviation = "" if tree.std is None else f", ± {tree.std[leaf]:.2f} {of}"
    return f"{start}   [{tree.low[leaf]:.1f} .. {tree.high[leaf]:.1f} {of}{deviation}]"


def _per(of: str, quantity: Quantity) -> str:
    """Unit of a slope."""
    match quantity.unit:
        case unit if unit in UNITLESS:
            return of
        case "rad":
            return f"{of}/°"
        case "m":
            return f"{of}/m"
        case unit:
            return f"{of}/({unit})"


def _value(value: float, quantity: Quantity) -> str:
    if quantity.unit == "rad":
        return f"{value * DEGREES:.0f}°"
    return f"{value:.2f}" if quantity.unit in UNITLESS else f"{value:.2f} {quantity.unit}"
