"""The least that each tree of a model can say for boxes of features: the least over the leaves that a box meets.

A leaf's formula is a sum over features, so that what depends on one side of a pair is computed for that side alone.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.spans import Span
from models.tree_boxes import TreeBoxes

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]
Places = NDArray[np.intp]
Spans = tuple[Span, ...]

ROUNDING = 2.0**-21  # of the terms of a sum: eight units in the last place
FARTHEST = 10.0  # no feature is larger, in metres or radians


class LeafBounds:
    """Least values of the trees of one model.

    `slack` is how far single precision may be off, here and in the model itself.

    Args:
      boxes: Its trees.
    """

    def __init__(self, boxes: TreeBoxes) -> None:
        self.boxes = boxes
        self._tree = np.repeat(np.arange(len(boxes.first)), np.diff([*boxes.first, len(boxes.low)]))
        self._rises = boxes.slopes >= 0
        self._flat = not boxes.slopes.any()
        ends = np.maximum(*(np.abs(np.clip(side, -FARTHEST, FARTHEST)) for side in (boxes.lower, boxes.upper)))
        self.slack = ROUNDING * float((np.abs(boxes.intercept) + (np.abs(boxes.slopes) * ends).sum(axis=1)).max())

    @property
    def leaves(self) -> int:
        """Of all trees."""
        return len(self._tree)

    def least(self, features: Spans, k_std: float = 0.0, trees: Bools | None = None) -> Floats:
        """The least of each tree, shape (trees, ...), for features whose spans broadcast to (...).

        Where leaves have a spread of their own, `k_std` times that is added. Only `trees` are asked, where given.
        """
        leaves = np.arange(self.leaves) if trees is None else np.flatnonzero(trees[self._tree])
        leaves, met = self._met(features, leaves)
        said = self._formulas(features, leaves)
        if self.boxes.spread is not None:
            said = said + _along(np.float32(k_std) * self.boxes.spread[leaves], features)
        total = np.where(met, said, np.float32(np.inf))
        starts = np.flatnonzero(np.diff(self._tree[leaves], prepend=-1))
        least: Floats = np.minimum.reduceat(total, starts, axis=0)
        return least

    def _met(self, features: Spans, leaves: Places) -> tuple[Places, Bools]:
        """The leaves that any box meets, and which boxes meet each, (leaves, ...): the quick questions come first."""
        masks: dict[tuple[int, ...], Bools] = {}
        for j in sorted(range(len(features)), key=lambda j: features[j].lower.size):
            lower, upper = _single(features[j])
            beyond = lower > _along(self.boxes.upper[leaves, j], features)
            met = ~(beyond | (upper <= _along(self.boxes.lower[leaves, j], features)))
            kept = met.reshape(len(leaves), -1).any(axis=1)
            if not kept.all():
                leaves, met = leaves[kept], met[kept]
                masks = {shape: mask[kept] for shape, mask in masks.items()}
            shape = met.shape[1:]
            masks[shape] = masks[shape] & met if shape in masks else met
        return leaves, reduce(np.logical_and, sorted(masks.values(), key=np.size))

    def _formulas(self, features: Spans, leaves: Places) -> Floats:
        """The least of each leaf's formula where a box meets it, (leaves, ...); a sum over features, by their shape."""
        boxes = self.boxes
        low = _along(boxes.low[leaves], features)
        if self._flat:
            return low
        sums: dict[tuple[int, ...], Floats] = {}
        for j, span in enumerate(features):
            lower, upper = _single(span)
            least = np.maximum(lower, _along(boxes.lower[leaves, j], features))
            most = np.minimum(upper, _along(boxes.upper[leaves, j], features))
            rises = _along(self._rises[leaves, j], features)
            part = np.where(rises, least, most) * _along(boxes.slopes[leaves, j], features)
            shape = part.shape[1:]
            sums[shape] = sums[shape] + part if shape in sums else part
        total = reduce(np.add, sorted(sums.values(), key=np.size), _along(boxes.intercept[leaves], features))
        clipped: Floats = np.minimum(np.maximum(total, low), _along(boxes.high[leaves], features))
        return clipped


def _along(values: NDArray[Any], features: Spans) -> NDArray[Any]:
    """One value a leaf, (leaves,), with axes for the boxes."""
    return values[(slice(None), *(None,) * features[0].lower.ndim)]


def _single(span: Span) -> tuple[Floats, Floats]:
    """Both ends in single precision, rounded as arguments are."""
    return span.lower.astype(np.float32), span.upper.astype(np.float32)
