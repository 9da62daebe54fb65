"""Bounds of an action model's predictions over boxes of arguments: the basis of proofs about the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from tailor.models.bounds.bag_bounds import bag_lower_bound
from tailor.models.bounds.interval_boxes import interval_boxes
from tailor.models.bounds.leaf_bounds import Floats, LeafBounds, Overlap, Side
from tailor.models.bounds.linear_bounds import linear_bound
from tailor.models.bounds.network_bounds import NetworkBounds, network_bounds
from tailor.models.bounds.onnx_reader import read_graph
from tailor.models.bounds.possible_boxes import select_possible
from tailor.models.bounds.tree_boxes import trees_of_graph
from tailor.models.features.feature_intervals import FEATURE_SPANS
from tailor.models.features.intervals import Array, Span
from tailor.models.features.linear_pieces import LINEAR_PIECES
from tailor.models.features.sight_intervals import Spans

Columns = tuple[Array, ...]  # one array per argument; they broadcast to one shape of three axes
MARGIN = 1e-4  # m or rad: far more than rounding moves the bounds of a part beyond those of the whole

ANY_STD = Span(np.zeros((1, 1, 1)), np.full((1, 1, 1), np.inf))  # the bound holds whatever the trees' std is
OFFSET_ROUNDING = np.float32(1e-5)  # of the difference of two predictions in single precision


@dataclass(frozen=True, slots=True)
class ModelBounds:
    """The bounds of one model, computed from its trees, its networks and its feature space.

    Attributes:
      space: Name of the feature space.
      trees: Bounds of the trees; None: the model has none.
      spread: Bounds of the tree of intervals; None: the standard deviation is that over the trees; any with networks.
      networks: Bounds of the networks; None: the model has none.
      share: Weight of the trees, 0..1; that of the networks is the rest.
    """

    space: str
    trees: LeafBounds | None
    spread: LeafBounds | None = None
    networks: NetworkBounds | None = None
    share: float = 1.0

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """The bounds restricted to arguments between these, with fewer leaves: much faster to compute."""
        cases = FEATURE_SPANS[self.space](tuple(map(Span, lower, upper)))
        hulls = tuple(reduce(Span.hull, spans) for spans in zip(*(case.features for case in cases), strict=True))
        spread = self.spread and self.spread.within((*hulls, ANY_STD), MARGIN)
        return replace(self, trees=self.trees and self.trees.within(hulls, MARGIN), spread=spread)

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
        arguments = tuple(map(Span, lower, upper))
        return -self._over_cases(arguments, lambda features, overlap: self._mean(features, overlap, Side.OPPOSITE))

    @property
    def is_linear(self) -> bool:
        """Whether there is a `linear_bound`."""
        return self.trees is None and self.networks is not None and self.space in LINEAR_PIECES

    def linear_bound(
        self, lower: Columns, upper: Columns, radius: Columns, k_std: float = 0.0
    ) -> tuple[Array, dict[int, Array]]:
        """Lower bound of the mean plus `k_std` standard deviations, as `linear_bounds.linear_bound`."""
        assert self.networks is not None

        def rest(features: Spans) -> Array:
            return k_std * self._least_spread(features).astype(np.float64)

        return linear_bound(self.networks, self.space, lower, upper, radius, rest if k_std > 0 else None)

    @property
    def effort(self) -> int:
        """Maximum number of leaves that one bound considers."""
        leaves = sum(part.leaves for part in (self.trees, self.spread) if part is not None)
        return leaves + (0 if self.networks is None else self.networks.effort)

    def _over_cases(self, arguments: Spans, least: Callable[[Spans, Overlap | None], Floats]) -> Array:
        """Minimum over all cases of the features, each where it is possible.

        If a tree has no leaf for a case, there are no such arguments: the case and sums with it are ignored.
        """
        shape = np.broadcast_shapes(*(span.lower.shape for span in arguments))
        bound = np.full(shape, np.inf)
        for case in FEATURE_SPANS[self.space](arguments):
            possible = np.broadcast_to(True if case.possible is None else case.possible, shape)
            if not possible.any():
                continue
            features, at = select_possible(case.features, possible)
            overlap = None if self.trees is None else self.trees.overlap(features)
            if overlap is None or not overlap.empty:
                with np.errstate(invalid="ignore"):
                    values = np.fmin(bound[at], least(features, overlap))
                bound[at] = np.where(possible[at], values, bound[at])
        return bound

    def _mean_and_std(self, features: Spans, overlap: Overlap | None, k_std: float) -> Floats:
        """Lower bound of the mean plus k standard deviations, shape (...)."""
        if k_std <= 0:
            return self._mean(features, overlap, Side.LEAST)
        trees = self.trees
        if self.spread is not None or self.networks is not None or trees is None or overlap is None:
            spread = np.float32(k_std) * self._least_spread(features)
            total: Floats = self._mean(features, overlap, Side.LEAST) + spread
            return total
        slack = np.float32(trees.slack)
        if trees.trees == 1:
            return np.asarray(trees.least(overlap, Side.LEAST, k_std)[0].mean(axis=0) - slack)
        least, opposite = trees.least(overlap, Side.BOTH)
        return bag_lower_bound(least, 2 * slack - opposite, k_std) - slack

    def _least_spread(self, features: Spans) -> Floats:
        """Lower bound of the standard deviation by the tree of intervals, shape (...); without one it may be zero."""
        if self.spread is None:
            return np.zeros((1, 1, 1), np.float32)
        std = ANY_STD
        if self.networks is not None and self.trees is None and self.spread.depends_on(len(features)):
            std = self.networks.deviation(features)
        least: Floats = self.spread.least(self.spread.overlap((*features, std)), Side.LEAST)[0, 0]
        return least - OFFSET_ROUNDING

    def _mean(self, features: Spans, overlap: Overlap | None, side: Side) -> Floats:
        """Lower bound of the mean, or of minus the mean (Side.OPPOSITE), shape (...)."""
        total: Floats = np.zeros((), np.float32)
        if self.trees is not None and overlap is not None:
            least = self.trees.least(overlap, side)[0].mean(axis=0) - np.float32(self.trees.slack)
            total = total + np.float32(self.share) * least
        if self.networks is not None:
            sign = 1 if side is Side.LEAST else -1
            total = total + np.float32(1 - self.share) * self.networks.least(features, sign)
        return total


def model_bounds(model: bytes, space: str, features: int) -> ModelBounds | None:
    """Bounds of an ONNX model.

    Args:
      model: Content of the ONNX file.
      space: Name of its feature space.
      features: Number of features.

    Returns:
      The bounds; None if the model is not made of trees and networks as the export writes them, or the feature space
      has no intervals.
    """
    if space not in FEATURE_SPANS:
        return None
    try:
        graph = read_graph(model)
    except ValueError:
        return None
    networks = network_bounds(graph)
    boxes = trees_of_graph(graph, features, blended=networks is not None)
    if boxes is None and networks is None:
        return None
    share = float(boxes is not None) if networks is None or boxes is None else networks.trees_share
    try:
        spread = interval_boxes(graph, features)
    except (ValueError, KeyError, IndexError):
        return None
    trees, widths = (None if part is None else LeafBounds(part) for part in (boxes, spread))
    return ModelBounds(space, trees, widths, networks, share)
