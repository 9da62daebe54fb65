"""Feature spaces in interval arithmetic: ranges of the features for boxes of arguments.

Each function is the interval form of its namesake in `features.py`; a test compares them on random boxes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.features import features
from tailor.models.features.features import NUMPY
from tailor.models.features.intervals import (
    ANGLE_ERROR,
    ARGUMENT_ERROR,
    NEAR,
    TURN,
    Span,
    direction,
    length,
    magnitude,
    unsigned,
)

Bools = NDArray[np.bool_]
Spans = tuple[Span, ...]
Wrapped = tuple[tuple[Span, Bools], tuple[Span, Bools]]  # intervals of an angle, and where each exists
FAR = 2 * NEAR  # m: beyond this distance the line of sight is unique
AT_REST = 1e-7  # well below SAME_PLACE of features.py


@dataclass(frozen=True, slots=True)
class Case:
    """One case of the features, where `possible`: angles wrap around, signs change."""

    features: Spans
    possible: Bools | None = None  # None: everywhere


def _direct(columns: Spans) -> tuple[Case, ...]:
    return (Case(columns),)


def _relative(columns: Spans) -> tuple[Case, ...]:
    x, y, phi, v, xg, yg, phig, vg = columns
    dx, dy = (xg - x).wider(ARGUMENT_ERROR), (yg - y).wider(ARGUMENT_ERROR)
    return (Case((dx, dy, phi, v, phig, vg)),)


def _projective(columns: Spans) -> tuple[Case, ...]:
    x, y, phi, v, xg, yg, phig, vg = columns
    dx, dy = xg - x, yg - y
    sight = _sight(x, y, xg, yg)
    to = sight - phi
    known = v, vg, length(dx, dy), unsigned(to)
    left, right = _may_lie_in_half(to, 0.0), _may_lie_in_half(to, -np.pi)
    cases = []
    for at, beyond in _wrapped(phig - sight):
        cases += [Case((*known, at), left & beyond), Case((*known, -at), right & beyond)]
    return tuple(cases)


def _projective_turn(columns: Spans) -> tuple[Case, ...]:
    turn = unsigned(columns[6] - columns[2])
    return tuple(Case((*case.features, turn), case.possible) for case in _projective(columns))


def _joints(columns: Spans) -> tuple[Case, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = ag - a, bg - b
    sight = _sight(a, b, ag, bg)
    known = length(wa, wb), length(wag, wbg), length(da, db)
    leaving = _wrapped(sight - _heading(wa, wb, sight))
    arriving = _wrapped(_heading(wag, wbg, sight) - sight)
    return tuple(Case((*known, to, at), first & second) for to, first in leaving for at, second in arriving)


def _joints_relative(columns: Spans) -> tuple[Case, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = (ag - a).wider(ARGUMENT_ERROR), (bg - b).wider(ARGUMENT_ERROR)
    return (Case((a, b, da, db, wa, wb, wag, wbg)),)


def _sight(x: Span, y: Span, xg: Span, yg: Span) -> Span:
    """Direction from one place to another; between known places exactly as features.py computes it."""
    known = x.known & y.known & xg.known & yg.known
    if not known.any():
        return direction(xg - x, yg - y)
    dx, dy = (np.float32(there.lower) - np.float32(here.lower) for here, there in ((x, xg), (y, yg)))
    with np.errstate(invalid="ignore", divide="ignore"):  # no direction at zero distance, which is excluded below
        length = features.length(dx, dy, NUMPY)
        exact = features.direction(dx, dy, length, 0.0, NUMPY)
    known = known & (length > FAR)
    if known.all():
        return Span(exact, exact)
    around = direction(xg - x, yg - y)
    return Span(np.where(known, exact, around.lower), np.where(known, exact, around.upper))


def _heading(wa: Span, wb: Span, sight: Span) -> Span:
    """Direction of a velocity; at rest that of the line of sight."""
    moving = direction(wa, wb)
    fastest = np.maximum(magnitude(wa).upper, magnitude(wb).upper)
    rests = fastest < AT_REST
    return Span(np.where(rests, sight.lower, moving.lower), np.where(rests, sight.upper, moving.upper))


def _wrapped(angle: Span) -> Wrapped:
    """Angles wrapped to [-pi, pi]: an interval up to pi, and a second one from -pi where they exceed pi."""
    wide = angle.wider(ANGLE_ERROR)
    turns = TURN * np.floor((wide.lower + np.pi) / TURN)
    whole = wide.upper - wide.lower >= TURN
    lower = np.where(whole, -np.pi, wide.lower - turns)
    upper = np.where(whole, np.pi, wide.upper - turns)
    beyond = np.asarray(upper > np.pi)
    first = Span(lower, np.minimum(upper, np.pi)).wider(ANGLE_ERROR)
    second = Span(np.full_like(upper, -np.pi), np.where(beyond, upper - TURN, -np.pi)).wider(ANGLE_ERROR)
    return (first, np.ones_like(beyond)), (second, beyond)


def _may_lie_in_half(angle: Span, begin: float) -> Bools:
    """Whether an angle, modulo whole turns, may lie in the half turn that starts at `begin`."""
    wide = angle.wider(ANGLE_ERROR)
    return np.asarray(np.floor((wide.upper - begin) / TURN) >= np.ceil((wide.lower - begin - np.pi) / TURN))


FEATURE_SPANS: Mapping[str, Callable[[Spans], tuple[Case, ...]]] = {
    "direct": _direct,
    "relative": _relative,
    "projective": _projective,
    "projective-turn": _projective_turn,
    "joints": _joints,
    "joints-relative": _joints_relative,
}
