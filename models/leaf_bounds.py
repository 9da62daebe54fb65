"""The least that each tree of a model can say for boxes of features: the least over the leaves that a box meets.

A leaf's formula is a sum over features, so that what depends on one side of a pair is computed for that side alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.spans import Span
from models.tree_boxes import TreeBoxes

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]
Spans = tuple[Span, ...]

NO_LEAF = np.float32(1e30)  # in sums instead of infinity, which the clip below could not tell from a large number
MET = np.float32(1e20)
ROUNDING = 2.0**-21  # of the terms of a sum: eight units in the last place
FARTHEST = 10.0  # no feature is larger, in metres or radians


class LeafBounds:
    """Least values of the trees of one model.

    `slack` is how far single precision may be off, here and in the model itself.

    Args:
      boxes: Its trees.
    """

    def __init__(self, boxes: TreeBoxes) -> None:
        self._boxes = boxes
        self._tree = np.repeat(np.arange(len(boxes.first)), np.diff([*boxes.first, len(boxes.low)]))
        self._rises = boxes.slopes >= 0
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
        order = sorted(range(len(features)), key=lambda j: features[j].lower.size)
        leaves = np.arange(self.leaves) if trees is None else np.flatnonzero(trees[self._tree])
        sums: dict[tuple[int, ...], Floats] = {}
        for j in order:
            said = self._term(features[j], j, leaves)
            met = (said < MET).reshape(len(leaves), -1).any(axis=1)
            leaves, said = leaves[met], said[met]
            sums = {shape: part[met] for shape, part in sums.items()}
            shape = said.shape[1:]
            sums[shape] = sums[shape] + said if shape in sums else said
        return self._of_trees(sums, leaves, np.float32(k_std))

    def _of_trees(self, sums: dict[tuple[int, ...], Floats], leaves: NDArray[np.intp], k_std: np.float32) -> Floats:
        """The least of each tree over its leaves, whose formulas' parts are given by shape."""
        boxes = self._boxes
        axes = (slice(None), *(None,) * len(next(iter(sums))))
        total = boxes.intercept[leaves][axes]
        for part in sorted(sums.values(), key=np.size):
            total = total + part
        missed = total > MET
        np.maximum(total, boxes.low[leaves][axes], out=total)
        np.minimum(total, boxes.high[leaves][axes], out=total)
        if boxes.spread is not None:
            total += k_std * boxes.spread[leaves][axes]
        total[missed] = np.inf
        trees = self._tree[leaves]
        starts = np.flatnonzero(np.diff(trees, prepend=-1))
        least: Floats = np.minimum.reduceat(total, starts, axis=0)
        return least

    def _term(self, span: Span, column: int, leaves: NDArray[np.intp]) -> Floats:
        """What one feature adds to each leaf at least, shape (leaves, ...); NO_LEAF where it lies outside."""
        boxes = self._boxes
        axes = (slice(None), *(None,) * np.ndim(span.lower))
        lower, upper = span.lower.astype(np.float32), span.upper.astype(np.float32)  # as arguments are rounded
        over, up_to = boxes.lower[leaves, column][axes], boxes.upper[leaves, column][axes]
        ends = np.where(self._rises[leaves, column][axes], np.maximum(lower, over), np.minimum(upper, up_to))
        said: Floats = ends * boxes.slopes[leaves, column][axes]
        said[(lower > up_to) | (upper <= over)] = NO_LEAF
        return said
