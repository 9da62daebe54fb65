"""The least and the most that each tree of a model can say for boxes of features, over the leaves that a box meets.

A leaf's formula is a sum over features, so that what depends on one side of a pair is computed for that side alone.
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
FARTHEST = 10.0  # no feature is larger, in metres or radians
AXES = 3  # of boxes: ways, before, own
WORTH_LEAVING_OUT = 10_000  # boxes and leaves: fewer are compared sooner than the leaves that none meets are left out


class Side(Enum):
    """What is asked of trees: the least that they say, the least of the opposite (minus the most), or both."""

    LEAST = slice(0, 1)
    OPPOSITE = slice(1, 2)
    BOTH = slice(0, 2)


@dataclass(frozen=True, slots=True)
class Meeting:
    """Boxes of features, and the leaves that any of them meets."""

    ends: tuple[Ends, ...]  # of each feature, in single precision, which arguments are rounded to
    leaves: Places | slice
    met: Bools  # (leaves, ...) which boxes meet each
    starts: Places  # first of each tree's leaves
    empty: bool  # a tree has no leaf that any box meets: there are no such features


class LeafBounds:
    """Least and largest values of the trees of one model.

    `slack` is how far single precision may be off, here and in the model itself.

    Args:
      boxes: Its trees.
      slack: If it is known already.
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
        """The same trees for features that lie within these, or `margin` beside them.

        Leaves that are out of reach are left out, and of the others the sides that no such features are beyond.
        """
        wide = tuple(span.wider(margin) for span in features)
        meeting = self.meeting(wide)
        reached = np.zeros(self.leaves, bool)
        reached[meeting.leaves] = meeting.met.reshape(len(meeting.met), -1).any(axis=1)
        lowest, highest = np.array([(span.lower.min(), span.upper.max()) for span in wide]).T
        return LeafBounds(self.boxes.part(reached).inside(lowest, highest), self.slack)

    def meeting(self, features: Spans) -> Meeting:
        """Which leaves are met by features whose spans broadcast to (...)."""
        ends = tuple((span.lower.astype(np.float32), span.upper.astype(np.float32)) for span in features)
        masks: dict[tuple[int, ...], Bools] = {}
        for j in self._decide:
            lower, upper = ends[j]
            met = (lower <= self._upper[j]) & (upper > self._lower[j])
            shape = met.shape[1:]
            masks[shape] = masks[shape] & met if shape in masks else met
        sides = sorted(masks.values(), key=np.size) or [np.ones((self.leaves, *(1,) * AXES), bool)]
        leaves, starts = self._worth(sides)
        met = reduce(np.logical_and, (side[leaves] for side in sides))
        empty = bool((starts == np.append(starts[1:], len(met))).any())
        return Meeting(ends, leaves, met, starts, empty)

    def _worth(self, sides: list[Bools]) -> tuple[Places | slice, Places]:
        """The leaves to go on with, as each side meets them, and where each tree begins among them."""
        if self.leaves * prod(np.broadcast_shapes(*(side.shape[1:] for side in sides))) < WORTH_LEAVING_OUT:
            return slice(None), self.boxes.first
        leaves = np.flatnonzero(reduce(np.logical_and, (side.reshape(self.leaves, -1).any(axis=1) for side in sides)))
        return leaves, np.searchsorted(leaves, self.boxes.first)

    def least(self, meeting: Meeting, side: Side, k_std: float = 0.0) -> Floats:
        """The least of each tree, shape (sides, trees, ...); where leaves have a spread, with `k_std` times that."""
        said = self._formulas(meeting, side)
        if k_std and self.boxes.std is not None:
            said = said + _along(np.float32(k_std) * self.boxes.std[meeting.leaves])
        total = np.where(meeting.met, said, np.float32(np.inf))
        least: Floats = np.minimum.reduceat(total, meeting.starts, axis=1)
        return least

    def _formulas(self, meeting: Meeting, side: Side) -> Floats:
        """The least of each leaf's formula where a box meets it, (sides, leaves, ...): a sum over features."""
        side_of, leaves = side.value, meeting.leaves
        low, high, total = (each[side_of, leaves] for each in (self._low, self._high, self._intercept))
        if not len(self._count):
            return low
        sums: dict[tuple[int, ...], Floats] = {}
        for j in self._count:
            lower, upper = meeting.ends[j]
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
    """One value a leaf, (..., leaves), with the axes of boxes behind it."""
    return np.ascontiguousarray(values).reshape(*values.shape, *(1,) * AXES)
