"""What an action model says at least, or at most, while its arguments lie in boxes: what a proof about it rests on.

A bag's spread is bounded from below by a plane that touches it, so that it never costs more than the mean's bound does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.feature_spans import FEATURE_SPANS, Spans
from models.leaf_bounds import Floats, LeafBounds
from models.spans import Array, Span
from models.tree_boxes import tree_boxes

LEAST_SPREAD = 1e-9  # s: below, all trees agree
Columns = tuple[Array, ...]  # one array an argument; they broadcast to one shape of three axes


@dataclass(frozen=True, slots=True)
class ModelBounds:
    """The bounds of one model, from its trees and its feature space."""

    space: str
    lowest: LeafBounds
    highest: LeafBounds  # of trees that say the opposite

    def least(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """The least mean plus `k_std` standard deviations, for arguments between `lower` and `upper`."""
        return self._over_cases(tuple(map(Span, lower, upper)), lambda features: self._spread(features, k_std))

    def most(self, lower: Columns, upper: Columns) -> Array:
        """The largest mean, for arguments between `lower` and `upper`."""
        highest = self.highest
        return -self._over_cases(
            tuple(map(Span, lower, upper)), lambda features: highest.least(features).mean(axis=0) - highest.slack
        )

    @property
    def effort(self) -> int:
        """Leaves that one bound looks at, at most."""
        return self.lowest.leaves

    def _over_cases(self, arguments: Spans, least: Callable[[Spans], Floats]) -> Array:
        """The least over all cases in which the features may come about, each for the part where it is possible."""
        shape = np.broadcast_shapes(*(span.lower.shape for span in arguments))
        found = np.full(shape, np.inf)
        for case in FEATURE_SPANS[self.space](arguments):
            possible = np.broadcast_to(True if case.possible is None else case.possible, shape)
            place = tuple(np.flatnonzero(possible.any(axis=other)) for other in ((1, 2), (0, 2), (0, 1)))
            if not len(place[0]):
                continue
            said, at = least(tuple(_picked(span, place) for span in case.features)), np.ix_(*place)
            found[at] = np.where(possible[at], np.minimum(found[at], said), found[at])
        return found

    def _spread(self, features: Spans, k_std: float) -> Floats:
        """Mean plus k standard deviations of the trees, shape (...), at least.

        That is convex in what the trees say. Its tangent plane at their least values has weights 1 + k z, z being the
        standard scores. Trees with a negative weight, far below the others, count with the most that they say; or all
        such weights are set to zero, and what their trees say does not matter: the better of the two.
        """
        lasting = self.lowest.least(features, k_std)
        mean: Floats = lasting.mean(axis=0)
        if k_std <= 0 or len(lasting) == 1:
            return mean - np.float32(self.lowest.slack)
        off = lasting - mean
        spread = np.sqrt((off * off).mean(axis=0))
        weights = 1 + k_std * off / np.maximum(spread, LEAST_SPREAD)
        least = mean + k_std * _projected(weights, off, k_std)
        outliers = (weights < 0).any(axis=tuple(range(1, weights.ndim)))
        if outliers.any():
            most = -self.highest.least(features, 0.0, outliers)
            rise = np.minimum(weights[outliers], 0.0) * (most - lasting[outliers] + self.highest.slack)
            least = np.maximum(least, mean + k_std * spread + rise.sum(axis=0) / len(lasting))
        return np.asarray(least - self.lowest.slack, np.float32)


def model_bounds(model: bytes, space: str, features: int) -> ModelBounds | None:
    """The bounds of an ONNX model, with so many features; None where it, or its feature space, is not of the kind."""
    boxes = tree_boxes(model, features) if space in FEATURE_SPANS else None
    return None if boxes is None else ModelBounds(space, LeafBounds(boxes), LeafBounds(boxes.negated()))


def _projected(weights: Floats, off: Floats, k_std: float) -> Floats:
    """The mean product of scores and deviations, with scores that give no tree a weight below zero."""
    kept = np.maximum(weights, 0.0)
    total = kept.mean(axis=0)  # one, but for rounding where the trees agree to the last bit
    scores = np.where(total > 0.0, kept / np.where(total > 0.0, total, 1.0) - 1, 0.0) / k_std
    scores /= np.maximum(np.sqrt((scores * scores).mean(axis=0)), 1.0)
    product: Floats = (scores * off).mean(axis=0)
    return product


def _picked(span: Span, place: tuple[NDArray[np.intp], ...]) -> Span:
    """The part of a span at some ways, boxes before and own boxes; what does not vary along an axis stays as it is."""
    lower, upper = span.lower, span.upper
    for axis, chosen in enumerate(place):
        if lower.shape[axis] > 1:
            lower, upper = lower.take(chosen, axis), upper.take(chosen, axis)
    return Span(lower, upper)
