"""Linear lower bounds of networks over boxes of arguments, for the mean over several displaced copies of each box.

The bound is linear in the arguments: what a subgoal's value costs one action and saves the next one cancels. All copies
of a box share one relaxation of the networks, over the smallest box of features that holds them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.feature_boxes import boxes_between
from tailor.models.bounds.network_bounds import NetworkBounds
from tailor.models.features.intervals import Array, Span
from tailor.models.features.linear_pieces import KINKS, LINEAR_PIECES, Piece, Term
from tailor.models.features.sight_intervals import Spans

Columns = tuple[Array, ...]
Shape = tuple[int, ...]  # copies, boxes before, own boxes
LEAST_WIDTH = 1e-3  # of a feature in a piece; all pieces of a pair of points weigh the same


@dataclass(frozen=True, slots=True)
class _Fragments:
    """Parts of p pairs of boxes, in c copies, in each of which the features of all t terms are linear.

    `sign` times a term's feature, less `home`, is the distance of its argument from the middle of the argument's box.
    """

    pairs: NDArray[np.intp]  # (p,) that they belong to
    possible: NDArray[np.bool_]  # (c, p)
    lower: Array  # (t, c, p) ends of the features
    upper: Array
    sign: Array  # (t, p), 0 without an argument
    home: Span  # (t, c, p)

    @property
    def hull(self) -> tuple[Array, Array]:
        """Ends of the features over all copies, (t, p)."""
        lower = np.where(self.possible, self.lower, np.inf).min(axis=1)
        return lower, np.where(self.possible, self.upper, -np.inf).max(axis=1)

    def least(self, factor: Array, slopes: Array) -> Array:
        """Minimum of factors times the features less slopes times the arguments' distances, both (t, p); (c, p)."""
        tilt, slopes = (factor - slopes * self.sign)[:, None], slopes[:, None]
        ends = np.minimum(tilt * self.lower, tilt * self.upper)
        ends += np.minimum(slopes * self.home.lower, slopes * self.home.upper)
        return np.where(self.possible, ends.sum(axis=0), np.inf)


def linear_bound(
    networks: NetworkBounds, space: str, lower: Columns, upper: Columns, radius: Columns
) -> tuple[Array, dict[int, Array]]:
    """Lower bound of the mean over copies of pairs of boxes.

    Args:
      networks: The networks.
      space: Their feature space, one of LINEAR_PIECES.
      lower: Lower ends of each argument in each copy; the arrays broadcast to (copies, n, m).
      upper: Upper ends.
      radius: Half of each argument's range before it was displaced.

    Returns:
      The bound in the middle of each pair, (n, m), and its slope by argument, (n, m).
    """
    shape = np.broadcast_shapes(*(each.shape for each in (*lower, *upper)))
    middle = _middles(lower, upper, radius)
    pieces = tuple(LINEAR_PIECES[space](tuple(map(Span, lower, upper))))
    fragments = _joined([_fragments(piece, middle, shape) for piece in pieces])
    hull, pairs, count = fragments.hull, fragments.pairs, shape[1] * shape[2]
    constant, factor = _plane(networks, pieces[0], *hull)
    # a pair in several pieces has the slopes of each in proportion to its size
    weight = np.prod(np.where(fragments.sign == 0, 1.0, LEAST_WIDTH + hull[1] - hull[0]), axis=0)
    weights = np.bincount(pairs, weight, count)
    slopes = np.array([np.bincount(pairs, each, count) for each in weight * fragments.sign * factor]) / weights
    least = np.full((count, shape[0]), np.inf)
    np.minimum.at(least, pairs, (constant + fragments.least(factor, slopes[:, pairs])).T)
    terms = zip(pieces[0].terms, (slope.reshape(shape[1:]) for slope in slopes), strict=True)
    by_argument = {term.argument: slope for term, slope in terms if term.argument is not None}
    value = least.mean(axis=1).reshape(shape[1:])
    highest = value + sum(np.abs(slope) * radius[j][0] for j, slope in by_argument.items())
    return value - np.maximum(highest - networks.high, 0.0), by_argument


def _middles(lower: Columns, upper: Columns, radius: Columns) -> Spans:
    """Displaced arguments in the middle of their box: not unique if they are clipped in a part of the box only."""
    ends = ((low + half, high - half) for low, high, half in zip(lower, upper, radius, strict=True))
    return tuple(Span(np.minimum(*end), np.maximum(*end)) for end in ends)


def _fragments(piece: Piece, middle: Spans, shape: Shape) -> _Fragments:
    """The pairs of boxes in one piece, where it is possible."""
    possible = np.broadcast_to(piece.possible, shape).reshape(shape[0], -1)
    pairs = np.flatnonzero(possible.any(axis=0))

    def flat(values: Sequence[Array | float]) -> Array:
        filled = np.empty((len(values), *shape))
        for row, each in zip(filled, values, strict=True):
            row[...] = each  # np.broadcast_to takes ten times as long
        return filled.reshape(len(values), shape[0], -1)[:, :, pairs]

    spans, homes = [term.span for term in piece.terms], [_home(term, middle) for term in piece.terms]
    sign = flat([0.0 if term.argument is None else term.sign for term in piece.terms])[:, 0]
    lower, upper, *home = (flat(ends) for spans in (spans, homes) for ends in _ends(spans))
    return _Fragments(pairs, possible[:, pairs], lower, upper, sign, Span(*home))


def _ends(spans: Sequence[Span]) -> tuple[list[Array], list[Array]]:
    return [span.lower for span in spans], [span.upper for span in spans]


def _joined(parts: Sequence[_Fragments]) -> _Fragments:
    """All parts, one after another."""
    if len(parts) == 1:
        return parts[0]
    home = Span(*(np.concatenate(ends, axis=2) for ends in _ends([part.home for part in parts])))
    pairs, possible, lower, upper, sign = (
        np.concatenate([getattr(part, name) for part in parts], axis=-1)
        for name in ("pairs", "possible", "lower", "upper", "sign")
    )
    return _Fragments(pairs, possible, lower, upper, sign, home)


def _home(term: Term, middle: Spans) -> Span:
    """Sign times the rest of a term, plus its argument in the middle of the box."""
    if term.argument is None:
        return term.rest
    ends = term.sign * term.rest.lower, term.sign * term.rest.upper
    at = middle[term.argument]
    return Span(np.minimum(*ends) + at.lower, np.maximum(*ends) + at.upper)


def _plane(networks: NetworkBounds, piece: Piece, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Constants, (p,), and factors of the terms, (t, p), of the bound over boxes of features, (t, p)."""
    if piece.curve is None:
        constant, slopes = networks.plane(boxes_between(lower.astype(np.float32), upper.astype(np.float32)))
        return constant.astype(np.float64), slopes.astype(np.float64)
    last = len(lower) - 1
    kinks = (np.clip(kink, lower[last], upper[last]) for kink in KINKS)
    angles = np.stack([lower[last], *kinks, upper[last]])
    corners = np.stack([angles, *piece.curve(angles)])
    ends = lower[:last].astype(np.float32), upper[:last].astype(np.float32)
    constant, slopes = networks.plane(boxes_between(*ends, corners.astype(np.float32)))
    factor = slopes[: last + 1].astype(np.float64)
    bend = (slopes[last:, None] * corners).sum(axis=0)  # along the curve, replaced by its chord
    width = angles[-1] - angles[0]
    factor[last] = np.divide(bend[-1] - bend[0], width, out=np.zeros_like(width), where=width > 0)
    return constant + (bend - factor[last] * angles).min(axis=0), factor
