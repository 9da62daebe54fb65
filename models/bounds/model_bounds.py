"""What an action model says at least, or at most, while its arguments lie in boxes: what a proof about it rests on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.bag_bounds import bag_lower_bound
from tailor.models.bounds.leaf_bounds import Floats, LeafBounds, Meeting, Side
from tailor.models.bounds.tree_boxes import tree_boxes
from tailor.models.features.feature_intervals import FEATURE_SPANS, Spans
from tailor.models.features.intervals import Array, Span

Columns = tuple[Array, ...]  # one array an argument; they broadcast to one shape of three axes
MARGIN = 1e-4  # m or rad: far more than the bounds of a part can reach beyond those of the whole, by rounding

WORTH_PICKING = 200  # pairs of boxes, by way


@dataclass(frozen=True, slots=True)
class ModelBounds:
    """The bounds of one model, from its trees and its feature space."""

    space: str
    trees: LeafBounds

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """The same for arguments that lie between these, where fewer leaves can be met: much quicker to compute."""
        cases = FEATURE_SPANS[self.space](tuple(map(Span, lower, upper)))
        hulls = (reduce(Span.hull, spans) for spans in zip(*(case.features for case in cases), strict=True))
        return replace(self, trees=self.trees.within(tuple(hulls), MARGIN))

    def lower_bound(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """The least mean plus `k_std` standard deviations, for arguments between `lower` and `upper`."""
        return self._over_cases(tuple(map(Span, lower, upper)), lambda meeting: self._spread(meeting, k_std))

    def upper_bound(self, lower: Columns, upper: Columns) -> Array:
        """The largest mean, for arguments between `lower` and `upper`."""
        trees = self.trees
        return -self._over_cases(
            tuple(map(Span, lower, upper)),
            lambda meeting: trees.least(meeting, Side.OPPOSITE)[0].mean(axis=0) - trees.slack,
        )

    @property
    def effort(self) -> int:
        """Leaves that one bound looks at, at most."""
        return self.trees.leaves

    def _over_cases(self, arguments: Spans, least: Callable[[Meeting], Floats]) -> Array:
        """The least over all cases in which the features may come about, each for the part where it is possible.

        Where a tree has no leaf for a case, there are no such arguments: that says nothing, nor do sums with it.
        """
        shape = np.broadcast_shapes(*(span.lower.shape for span in arguments))
        found = np.full(shape, np.inf)
        for case in FEATURE_SPANS[self.space](arguments):
            possible = np.broadcast_to(True if case.possible is None else case.possible, shape)
            if not possible.any():
                continue
            features, at = _picked(case.features, possible)
            meeting = self.trees.meeting(features)
            if not meeting.empty:
                with np.errstate(invalid="ignore"):
                    said = np.fmin(found[at], least(meeting))
                found[at] = np.where(possible[at], said, found[at])
        return found

    def _spread(self, meeting: Meeting, k_std: float) -> Floats:
        """Mean plus k standard deviations of the trees, shape (...), at least."""
        trees, slack = self.trees, np.float32(self.trees.slack)
        if k_std <= 0 or trees.trees == 1:
            mean: Floats = trees.least(meeting, Side.LEAST, k_std)[0].mean(axis=0) - slack
            return mean
        least, opposite = trees.least(meeting, Side.BOTH)
        return bag_lower_bound(least, 2 * slack - opposite, k_std) - slack


def model_bounds(model: bytes, space: str, features: int) -> ModelBounds | None:
    """The bounds of an ONNX model, with so many features; None where it, or its feature space, is not of the kind."""
    boxes = tree_boxes(model, features) if space in FEATURE_SPANS else None
    return None if boxes is None else ModelBounds(space, LeafBounds(boxes))


def _picked(features: Spans, possible: NDArray[np.bool_]) -> tuple[Spans, Any]:
    """The features at those ways, boxes before and own boxes where they are possible at all, and where that is.

    All of them where it is not worth picking; what does not vary along an axis stays as it is.
    """
    if possible.size < WORTH_PICKING or possible.all():
        return features, ...
    place = tuple(np.flatnonzero(possible.any(axis=other)) for other in ((1, 2), (0, 2), (0, 1)))
    return tuple(Span(_taken(span.lower, place), _taken(span.upper, place)) for span in features), np.ix_(*place)


def _taken(values: Array, place: tuple[NDArray[np.intp], ...]) -> Array:
    for axis, chosen in enumerate(place):
        if values.shape[axis] > 1:
            values = values.take(chosen, axis)
    return values
