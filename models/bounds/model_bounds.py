"""Bounds of an action model's predictions over boxes of arguments: the basis of proofs about the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.bag_bounds import bag_lower_bound
from tailor.models.bounds.interval_boxes import interval_boxes
from tailor.models.bounds.leaf_bounds import Floats, LeafBounds, Overlap, Side
from tailor.models.bounds.tree_boxes import tree_boxes
from tailor.models.features.feature_intervals import FEATURE_SPANS
from tailor.models.features.intervals import Array, Span
from tailor.models.features.sight_intervals import Spans

Columns = tuple[Array, ...]  # one array per argument; they broadcast to one shape of three axes
MARGIN = 1e-4  # m or rad: far more than rounding moves the bounds of a part beyond those of the whole

ANY_STD = Span(np.zeros((1, 1, 1)), np.full((1, 1, 1), np.inf))  # the bound holds whatever the trees' std is
OFFSET_ROUNDING = np.float32(1e-5)  # of the difference of two predictions in single precision

MIN_SELECTION = 200  # pairs of boxes, by case; below, selecting the possible ones costs more than it saves


@dataclass(frozen=True, slots=True)
class ModelBounds:
    """The bounds of one model, computed from its trees and its feature space.

    `spread` are the bounds of the tree of intervals; None: the standard deviation is that over the trees.
    """

    space: str
    trees: LeafBounds
    spread: LeafBounds | None = None

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """The bounds restricted to arguments between these, with fewer leaves: much faster to compute."""
        cases = FEATURE_SPANS[self.space](tuple(map(Span, lower, upper)))
        hulls = tuple(reduce(Span.hull, spans) for spans in zip(*(case.features for case in cases), strict=True))
        spread = self.spread and self.spread.within((*hulls, ANY_STD), MARGIN)
        return replace(self, trees=self.trees.within(hulls, MARGIN), spread=spread)

    def lower_bound(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """Lower bound of the mean plus `k_std` standard deviations over boxes of arguments.

        Args:
          lower: Lower ends of each argument; the arrays broadcast to one shape of three axes.
          upper: Upper ends.
          k_std: Number of standard deviations.

        Returns:
          Seconds, joules or probability, of the broadcast shape.
        """
        arguments = tuple(map(Span, lower, upper))
        return self._over_cases(arguments, lambda features, overlap: self._mean_and_std(features, overlap, k_std))

    def upper_bound(self, lower: Columns, upper: Columns) -> Array:
        """Upper bound of the mean over boxes of arguments, as `lower_bound`."""
        trees = self.trees
        return -self._over_cases(
            tuple(map(Span, lower, upper)),
            lambda _, overlap: trees.least(overlap, Side.OPPOSITE)[0].mean(axis=0) - trees.slack,
        )

    @property
    def effort(self) -> int:
        """Maximum number of leaves that one bound considers."""
        return self.trees.leaves + (0 if self.spread is None else self.spread.leaves)

    def _over_cases(self, arguments: Spans, least: Callable[[Spans, Overlap], Floats]) -> Array:
        """Minimum over all cases of the features, each where it is possible.

        If a tree has no leaf for a case, there are no such arguments: the case and sums with it are ignored.
        """
        shape = np.broadcast_shapes(*(span.lower.shape for span in arguments))
        bound = np.full(shape, np.inf)
        for case in FEATURE_SPANS[self.space](arguments):
            possible = np.broadcast_to(True if case.possible is None else case.possible, shape)
            if not possible.any():
                continue
            features, at = _selected(case.features, possible)
            overlap = self.trees.overlap(features)
            if not overlap.empty:
                with np.errstate(invalid="ignore"):
                    values = np.fmin(bound[at], least(features, overlap))
                bound[at] = np.where(possible[at], values, bound[at])
        return bound

    def _mean_and_std(self, features: Spans, overlap: Overlap, k_std: float) -> Floats:
        """Lower bound of the mean plus k standard deviations, shape (...)."""
        trees, slack = self.trees, np.float32(self.trees.slack)
        if self.spread is not None and k_std > 0:
            spread = self.spread.least(self.spread.overlap((*features, ANY_STD)), Side.LEAST)[0, 0] - OFFSET_ROUNDING
            total: Floats = trees.least(overlap, Side.LEAST)[0].mean(axis=0) - slack + np.float32(k_std) * spread
            return total
        if k_std <= 0 or trees.trees == 1:
            mean: Floats = trees.least(overlap, Side.LEAST, k_std)[0].mean(axis=0) - slack
            return mean
        least, opposite = trees.least(overlap, Side.BOTH)
        return bag_lower_bound(least, 2 * slack - opposite, k_std) - slack


def model_bounds(model: bytes, space: str, features: int) -> ModelBounds | None:
    """Bounds of an ONNX model.

    Args:
      model: Content of the ONNX file.
      space: Name of its feature space.
      features: Number of features.

    Returns:
      The bounds; None if the model is not made of trees, or the feature space has no intervals.
    """
    boxes = tree_boxes(model, features) if space in FEATURE_SPANS else None
    if boxes is None:
        return None
    spread = interval_boxes(model, features)
    return ModelBounds(space, LeafBounds(boxes), None if spread is None else LeafBounds(spread))


def _selected(features: Spans, possible: NDArray[np.bool_]) -> tuple[Spans, Any]:
    """The features of those cases and boxes that are possible at all, and their indices.

    All of them if there are fewer than MIN_SELECTION; arrays that do not vary along an axis stay as they are.
    """
    if possible.size < MIN_SELECTION or possible.all():
        return features, ...
    place = tuple(np.flatnonzero(possible.any(axis=other)) for other in ((1, 2), (0, 2), (0, 1)))
    return tuple(Span(_taken(span.lower, place), _taken(span.upper, place)) for span in features), np.ix_(*place)


def _taken(values: Array, place: tuple[NDArray[np.intp], ...]) -> Array:
    for axis, chosen in enumerate(place):
        if values.shape[axis] > 1:
            values = values.take(chosen, axis)
    return values
