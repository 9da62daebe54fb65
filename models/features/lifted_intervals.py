"""The feature space "joints-lifted" in interval arithmetic; see `joints.py`."""

from __future__ import annotations

import numpy as np

from tailor.models.features.intervals import ARGUMENT_ERROR, NEAR, TURN, Span, length, magnitude
from tailor.models.features.sight_intervals import Case, Spans, sight

PRODUCT_ERROR = 1e-4  # rad/s: directions of ways beyond NEAR in single precision, less by a thousandth at NEAR
SHORTENED = 1e-3  # a direction is shorter than 1 by less, beyond NEAR


def joints_lifted(columns: Spans) -> tuple[Case, ...]:
    """Ranges of the features for boxes of joint states."""
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = (ag - a).wider(ARGUMENT_ERROR), (bg - b).wider(ARGUMENT_ERROR)
    way, line = length(da, db), sight(a, b, ag, bg)
    ca, cb = _cosines(line), _cosines(Span(line.lower - TURN / 4, line.upper - TURN / 4))
    near = way.lower < 2 * NEAR  # the direction may be any, and shorter than 1
    ca, cb = (Span(np.where(near, -1.0, c.lower), np.where(near, 1.0, c.upper)) for c in (ca, cb))
    features = [b, magnitude(da), db, way]
    for va, vb in ((wa, wb), (wag, wbg)):
        features += [_sum(_product(ca, va), _product(cb, vb)), _mirrored(_product(ca, vb) - _product(cb, va), da)]
    return (Case(tuple(features)),)


def _mirrored(across: Span, da: Span) -> Span:
    """The same where the way leads to the right, turned round where it leads to the left."""
    left, right = da.lower < 0.0, da.upper >= 0.0
    lower = np.minimum(np.where(right, across.lower, np.inf), np.where(left, -across.upper, np.inf))
    upper = np.maximum(np.where(right, across.upper, -np.inf), np.where(left, -across.lower, -np.inf))
    return Span(lower, upper)


def _sum(first: Span, second: Span) -> Span:
    return first - -second


def _product(first: Span, second: Span) -> Span:
    ends = [one * other for one in (first.lower, first.upper) for other in (second.lower, second.upper)]
    return Span(np.minimum.reduce(ends), np.maximum.reduce(ends)).wider(PRODUCT_ERROR)


def _cosines(angle: Span) -> Span:
    """Cosines of angles, of directions a little shorter than 1."""
    ends = np.cos(angle.lower), np.cos(angle.upper)
    ahead = np.floor(angle.upper / TURN) >= np.ceil(angle.lower / TURN)
    opposite = np.floor((angle.upper - np.pi) / TURN) >= np.ceil((angle.lower - np.pi) / TURN)
    lower, upper = np.where(opposite, -1.0, np.minimum(*ends)), np.where(ahead, 1.0, np.maximum(*ends))
    return Span(lower, upper).wider(SHORTENED)
