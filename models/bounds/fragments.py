"""Parts of pairs of boxes of arguments in each of which the features are linear: where angles neither wrap nor fold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.features.intervals import Array, Span
from tailor.models.features.linear_pieces import KINKS, Piece, Term
from tailor.models.features.sight_intervals import Spans

Columns = tuple[Array, ...]
Shape = tuple[int, ...]  # copies, boxes before, own boxes


@dataclass(frozen=True, slots=True)
class Fragments:
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
        total: Array = ends.sum(axis=0)
        return total

    def features(self, piece: Piece) -> Spans:
        """Each feature of each copy, those along the curve included, of the shape (c, p, 1)."""
        spans = [Span(low[..., None], high[..., None]) for low, high in zip(self.lower, self.upper, strict=True)]
        if piece.curve is None:
            return tuple(spans)
        along = piece.curve(corners(self.lower[-1], self.upper[-1]))
        return *spans, *(Span(at.min(axis=0)[..., None], at.max(axis=0)[..., None]) for at in along)


def corners(lower: Array, upper: Array) -> Array:
    """The angles between which features along a curve are linear: both ends and KINKS, clipped; (v, ...)."""
    return np.stack([lower, *(np.clip(kink, lower, upper) for kink in KINKS), upper])


def fragments_of(pieces: Sequence[Piece], lower: Columns, upper: Columns, radius: Columns, shape: Shape) -> Fragments:
    """The parts of all pairs of boxes in each piece, where it is possible."""
    middle = _middles(lower, upper, radius)
    return _joined([_fragments(piece, middle, shape) for piece in pieces])


def _middles(lower: Columns, upper: Columns, radius: Columns) -> Spans:
    """Displaced arguments in the middle of their box: not unique if they are clipped in a part of the box only."""
    ends = ((low + half, high - half) for low, high, half in zip(lower, upper, radius, strict=True))
    return tuple(Span(np.minimum(*end), np.maximum(*end)) for end in ends)


def _fragments(piece: Piece, middle: Spans, shape: Shape) -> Fragments:
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
    return Fragments(pairs, possible[:, pairs], lower, upper, sign, Span(*home))


def _ends(spans: Sequence[Span]) -> tuple[list[Array], list[Array]]:
    return [span.lower for span in spans], [span.upper for span in spans]


def _joined(parts: Sequence[Fragments]) -> Fragments:
    """All parts, one after another."""
    if len(parts) == 1:
        return parts[0]
    home = Span(*(np.concatenate(ends, axis=2) for ends in _ends([part.home for part in parts])))
    pairs, possible, lower, upper, sign = (
        np.concatenate([getattr(part, name) for part in parts], axis=-1)
        for name in ("pairs", "possible", "lower", "upper", "sign")
    )
    return Fragments(pairs, possible, lower, upper, sign, home)


def _home(term: Term, middle: Spans) -> Span:
    """Sign times the rest of a term, plus its argument in the middle of the box."""
    if term.argument is None:
        return term.rest
    ends = term.sign * term.rest.lower, term.sign * term.rest.upper
    at = middle[term.argument]
    return Span(np.minimum(*ends) + at.lower, np.maximum(*ends) + at.upper)
