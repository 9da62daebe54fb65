"""Bounds of each tree of a model over boxes of features, from the leaves that a box overlaps.

A leaf's formula is a sum over features, so terms that depend on one side of a pair are computed for that side only.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import reduce
from math import prod

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.tree_boxes import TreeBoxes
from tailor.models.features.intervals import Span

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]
Places = NDArray[np.intp]
Spans = tuple[Span, ...]
Ends = tuple[Floats, Floats]

ROUNDING = 2.0**-21  # of the terms of a sum: eight units in the last place
FARTHEST = 10.0  # magnitude limit of features, in metres or radians
AXES = 3  # of boxes: cases, boxes of the values before, boxes of the own values
MIN_SELECTION = 10_000  # comparisons; below, selecting the overlapping leaves costs more than it saves


class Side(Enum):
    """Requested bound: the minimum, the minimum of the negative (minus the maximum), or both."""

    LEAST = slice(0, 1)
    OPPOSITE = slice(1, 2)
    BOTH = slice(0, 2)


@dataclass(frozen=True, slots=True)
class Overlap:
    """Boxes of features, and the leaves that any of them overlaps."""

    ends: tuple[Ends, ...]  # of each feature, in single precision, to which arguments are rounded
    leaves: Places | slice
    met: Bools  # (leaves, ...) whether each box overlaps the leaf
    starts: Places  # first leaf of each tree
    empty: bool  # a tree has no leaf that any box overlaps: such features do not exist


class LeafBounds:
    """Bounds of the trees of one model.

    `slack` bounds the rounding error of single precision, here and in the model.

    Args:
      boxes: The trees.
      slack: The rounding error, None to compute it.
    """

    def __init__(self, boxes: TreeBoxes, slack: float | None = None) -> None:
        self.boxes = boxes
        self.trees = len(boxes.first)
        self.leaves = len(boxes.low)
        self.slack = _slack(boxes) if slack is None else slack
        bounded = np.isfinite(boxes.lower) | np.isfinite(boxes.upper)
        self._decide, self._count = (np.flatnonzero(some.any(axis=0)) for some in (bounded, boxes.slopes))
        self._lower, self._upper = (_along(side.T) for side in (boxes.lower, boxes.upper))
        self._slopes = _along(np.stack([boxes.slopes.T, -boxes.slopes.T]))  # by side, feature, leaf
        self._intercept = _along(np.stack([boxes.intercept, -boxes.intercept]))
        self._low, self._high = (
            _along(np.stack(ends)) for ends in ((boxes.low, -boxes.high), (boxes.high, -boxes.low))
        )

    def within(self, features: Spans, margin: float) -> LeafBounds:
        """The bounds restricted to features within these spans, widened by `margin`.

        Leaves out of reach are left out, and so are the sides of leaves that no such feature can exceed.
        """
        wide = tuple(span.wider(margin) for span in features)
        overlap = self.overlap(wide)
        reached = np.zeros(self.leaves, bool)
        reached[overlap.leaves] = overlap.met.reshape(len(overlap.met), -1).any(axis=1)
        lowest, highest = np.array([(span.lower.min(), span.upper.max()) for span in wide]).T
        return LeafBounds(self.boxes.part(reached).inside(lowest, highest), self.slack)

    def depends_on(self, feature: int) -> bool:
        """Whether a side of some leaf bounds a feature."""
        return feature in self._decide

    def overlap(self, features: Spans) -> Overlap:
        """Leaves that overlap features whose spans broadcast to (...)."""
        ends = tuple((span.lower.astype(np.float32), span.upper.astype(np.float32)) for span in features)
        masks: dict[tuple[int, ...], Bools] = {}
        for j in self._decide:
            lower, upper = ends[j]
            met = (lower <= self._upper[j]) & (upper > self._lower[j])
            shape = met.shape[1:]
            masks[shape] = masks[shape] & met if shape in masks else met
        sides = sorted(masks.values(), key=np.size) or [np.ones((self.leaves, *(1,) * AXES), bool)]
        leaves, starts = self._selected(sides)
        met = reduce(np.logical_and, (side[leaves] for side in sides))
        empty = bool((starts == np.append(starts[1:], len(met))).any())
        return Overlap(ends, leaves, met, starts, empty)

    def _selected(self, sides: list[Bools]) -> tuple[Places | slice, Places]:
        """Leaves to consider, given the overlap by each side, and the first of each tree among them."""
        if self.leaves * prod(np.broadcast_shapes(*(side.shape[1:] for side in sides))) < MIN_SELECTION:
            return slice(None), self.boxes.first
        leaves = np.flatnonzero(reduce(np.logical_and, (side.reshape(self.leaves, -1).any(axis=1) for side in sides)))
        return leaves, np.searchsorted(leaves, self.boxes.first)

    def least(self, overlap: Overlap, side: Side, k_std: float = 0.0) -> Floats:
        """Minimum of each tree, shape (sides, trees, ...).

        Where leaves have a standard deviation of their own, `k_std` times that is added.
        """
        values = self._formulas(overlap, side)
        if k_std and self.boxes.std is not None:
            values = values + _along(np.float32(k_std) * self.boxes.std[overlap.leaves])
        total = np.where(overlap.met, values, np.float32(np.inf))
        least: Floats = np.minimum.reduceat(total, overlap.starts, axis=1)
        return least

    def _formulas(self, overlap: Overlap, side: Side) -> Floats:
        """Minimum of each leaf's formula where a box overlaps it, (sides, leaves, ...): a sum over features."""
        side_of, leaves = side.value, overlap.leaves
        low, high, total = (each[side_of, leaves] for each in (self._low, self._high, self._intercept))
        if not len(self._count):
            return low
        sums: dict[tuple[int, ...], Floats] = {}
        for j in self._count:
            lower, upper = overlap.ends[j]
            slopes = self._slopes[side_of, j, leaves]
            at_least = np.maximum(lower, self._lower[j, leaves]) * slopes
            part = np.minimum(at_least, np.minimum(upper, self._upper[j, leaves]) * slopes)
            shape = part.shape[2:]
            sums[shape] = sums[shape] + part if shape in sums else part
        total = reduce(np.add, sorted(sums.values(), key=np.size), total)
        clipped: Floats = np.minimum(np.maximum(total, low), high)
        return clipped


def _slack(boxes: TreeBoxes) -> float:
    ends = np.maximum(*(np.abs(np.clip(side, -FARTHEST, FARTHEST)) for side in (boxes.lower, boxes.upper)))
    return ROUNDING * float((np.abs(boxes.intercept) + (np.abs(boxes.slopes) * ends).sum(axis=1)).max())


def _along(values: Floats) -> Floats:
    """One value per leaf, (..., leaves), with the axes of boxes appended."""
    return np.ascontiguousarray(values).reshape(*values.shape, *(1,) * AXES)
