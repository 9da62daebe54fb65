"""Pieces of the arguments in which features are linear in them: the angles between a robot and its goal.

Angles wrap around and lose their sign, so the arguments are cut where they do. In a piece each feature is a multiple of
one argument, by 1 or -1, plus a rest that does not depend on that argument.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from tailor.models.features.intervals import ANGLE_ERROR, ARGUMENT_ERROR, TURN, Array, Span, length
from tailor.models.features.sight_intervals import Bools, Spans, sight
from tailor.models.features.straight_drive import SEEN
from tailor.models.features.straight_intervals import straight_or_bent

KINKS = (-np.pi / 2, 0.0, np.pi / 2)  # of the angle at the goal in "projective-periodic"
ZERO = Span(np.zeros((1, 1, 1)), np.zeros((1, 1, 1)))


@dataclass(frozen=True, slots=True)
class Term:
    """One feature in a piece: `sign` times an argument plus `rest`; without an argument only its span is known."""

    span: Span
    argument: int | None = None
    sign: Array | float = 1.0
    rest: Span = ZERO


@dataclass(frozen=True, slots=True)
class Piece:
    """Features where `possible`. If there is a `curve`, it adds features: functions of the last term.

    These are linear between KINKS.
    """

    terms: tuple[Term, ...]
    possible: Bools
    curve: Callable[[Array], tuple[Array, ...]] | None = None


def _projective(columns: Spans) -> Iterator[Piece]:
    x, y, phi, v, xg, yg, phig, vg = columns
    line = sight(x, y, xg, yg)
    speeds = Term(v.wider(ANGLE_ERROR), 3), Term(vg.wider(ANGLE_ERROR), 7)
    known = *speeds, Term(length(xg - x, yg - y).wider(ARGUMENT_ERROR))
    ahead, beyond = ((one - other).wider(ANGLE_ERROR) for one, other in ((line, phi), (phig, line)))
    halves, turns = list(_sectors(ahead, np.pi, 0.0)), list(_sectors(beyond, TURN, -np.pi))
    for (half, to, faces), (turn, at, wraps) in product(halves, turns):
        possible = faces & wraps
        if possible.any():
            left = np.where(half % 2 == 0, 1.0, -1.0)  # turns left to face the goal
            end = np.where(half % 2 == 0, half, half + 1.0) * np.pi
            towards = Term(_signed(to, end, left), 2, -left, _signed(line, end, left))
            arrival = Term(_signed(at, turn * TURN, left), 6, left, _signed(line, -turn * TURN, -left))
            yield Piece((*known, towards, arrival), possible)


def _projective_periodic(columns: Spans) -> Iterator[Piece]:
    for piece in _projective(columns):
        yield Piece(piece.terms, piece.possible, _periodic)


def _straight_drive(columns: Spans) -> Iterator[Piece]:
    for piece in _projective(columns[:SEEN]):
        dist, to, at = (term.span for term in piece.terms[2:])
        for straight, where in straight_or_bent(dist, to, at, columns[SEEN]):
            possible = piece.possible & where
            if possible.any():
                yield Piece((*piece.terms, Term(straight)), possible)


def _periodic(at: Array) -> tuple[Array, ...]:
    """The angle's magnitude, and the triangle wave that follows its sine."""
    half = at.dtype.type(np.pi / 2)
    return np.abs(at), np.abs(at + half) - np.abs(at - half) - at


def _sectors(angle: Span, width: float, begin: float) -> Iterator[tuple[Array, Span, Bools]]:
    """Sectors that an angle may lie in, from `begin` on: their index, the part of the angle there, where there is any.

    The index is the same for all copies, the first axis.
    """
    whole = angle.hull_of_copies()
    first, last = np.floor((whole.lower - begin) / width), np.floor((whole.upper - begin) / width)
    for step in range(int((last - first).max()) + 1):
        index = first + step
        low = begin + index * width
        lower, upper = np.maximum(angle.lower, low), np.minimum(angle.upper, low + width)
        possible = np.asarray(lower <= upper)
        yield index, Span(np.where(possible, lower, low), np.where(possible, upper, low)), possible


def _signed(angle: Span, end: Array, sign: Array) -> Span:
    """The angle less `end`, times 1 or -1, and rounded outward."""
    ends = sign * (angle.lower - end), sign * (angle.upper - end)
    return Span(np.minimum(*ends), np.maximum(*ends)).wider(ANGLE_ERROR)


LINEAR_PIECES: Mapping[str, Callable[[Spans], Iterator[Piece]]] = {
    "projective": _projective,
    "projective-periodic": _projective_periodic,
    "straight-drive": _straight_drive,
}
