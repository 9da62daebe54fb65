"""Lines of sight, their angles and the halves that these may lie in, on intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.models.features import features
from tailor.models.features.features import NUMPY
from tailor.models.features.intervals import ANGLE_ERROR, NEAR, TURN, Span, direction

Bools = NDArray[np.bool_]
Spans = tuple[Span, ...]
Wrapped = tuple[tuple[Span, Bools], tuple[Span, Bools]]  # intervals of an angle, and where each exists
FAR = 2 * NEAR  # m: beyond this distance the line of sight is unique


@dataclass(frozen=True, slots=True)
class Case:
    """One case of the features, where `possible`: angles wrap around, signs change."""

    features: Spans
    possible: Bools | None = None  # None: everywhere


def sight(x: Span, y: Span, xg: Span, yg: Span) -> Span:
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


def wrapped(angle: Span) -> Wrapped:
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


def may_lie_in_half(angle: Span, begin: float) -> Bools:
    """Whether an angle, modulo whole turns, may lie in the half turn that starts at `begin`."""
    wide = angle.wider(ANGLE_ERROR)
    return np.asarray(np.floor((wide.upper - begin) / TURN) >= np.ceil((wide.lower - begin - np.pi) / TURN))
