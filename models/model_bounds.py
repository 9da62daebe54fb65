"""What an action model says at least, or at most, while its arguments lie in boxes: what a proof about it rests on.

A bag's spread is bounded from below by a plane that touches it, so that it never costs more than the mean's bound does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.feature_spans import FEATURE_SPANS, Spans
from models.leaf_bounds import Floats, LeafBounds
from models.spans import Array, Span
from models.tree_boxes import tree_boxes

Columns = tuple[Array, ...]  # one array an argument; they broadcast to one shape of three axes


@dataclass(frozen=True, slots=True)
class ModelBounds:
    """The bounds of one model, from its trees and its feature space."""

    space: str
    lowest: LeafBounds
    highest: LeafBounds  # of trees that say the opposite

    def least(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """The least mean plus `k_std` standard deviations, for arguments between `lower` and `upper`."""
        return self._least(self.lowest, tuple(map(Span, lower, upper)), k_std)

    def most(self, lower: Columns, upper: Columns) -> Array:
        """The largest mean, for arguments between `lower` and `upper`."""
        return -self._least(self.highest, tuple(map(Span, lower, upper)), 0.0)

    def _least(self, leaves: LeafBounds, arguments: Spans, k_std: float) -> Array:
        """The least over all cases in which the features may come about, each for the part where it is possible."""
        shape = np.broadcast_shapes(*(span.lower.shape for span in arguments))
        found = np.full(shape, np.inf)
        for case in FEATURE_SPANS[self.space](arguments):
            possible = np.broadcast_to(True if case.possible is None else case.possible, shape)
            place = tuple(np.flatnonzero(possible.any(axis=other)) for other in ((1, 2), (0, 2), (0, 1)))
            if not len(place[0]):
                continue
            trees = leaves.least(tuple(_picked(span, place) for span in case.features), k_std)
            said = _mean_and_spread(trees, k_std) - leaves.slack
            at = np.ix_(*place)
            found[at] = np.where(possible[at], np.minimum(found[at], said), found[at])
        return found


def model_bounds(model: bytes, space: str, features: int) -> ModelBounds | None:
    """The bounds of an ONNX model, with so many features; None where it, or its feature space, is not of the kind."""
    boxes = tree_boxes(model, features) if space in FEATURE_SPANS else None
    return None if boxes is None else ModelBounds(space, LeafBounds(boxes), LeafBounds(boxes.negated()))


def _mean_and_spread(lasting: Floats, k_std: float) -> Floats:
    """Mean plus k standard deviations of the trees at least, shape (...), of their least values, (trees, ...).

    The sum is convex in what the trees say. Its tangent plane at their least values has weights 1 + k z, z being the
    standard scores; with the negative ones set to zero it never falls in any of them.
    """
    mean: Floats = lasting.mean(axis=0)
    if k_std <= 0 or len(lasting) == 1:
        return mean
    off = lasting - mean
    spread = np.sqrt((off * off).mean(axis=0))
    weights = np.maximum(1 + k_std * off / np.maximum(spread, 1e-9), 0.0)
    weights /= weights.mean(axis=0)
    scores = (weights - 1) / k_std
    scores /= np.maximum(np.sqrt((scores * scores).mean(axis=0)), 1.0)
    least: Floats = mean + k_std * (scores * off).mean(axis=0)
    return least


def _picked(span: Span, place: tuple[NDArray[np.intp], ...]) -> Span:
    """The part of a span at some ways, boxes before and own boxes; what does not vary along an axis stays as it is."""
    lower, upper = span.lower, span.upper
    for axis, chosen in enumerate(place):
        if lower.shape[axis] > 1:
            lower, upper = lower.take(chosen, axis), upper.take(chosen, axis)
    return Span(lower, upper)
