"""The feature space "one-obstacle" in interval arithmetic; see `obstacle.py`."""

from __future__ import annotations

import numpy as np

from tailor.models.features.intervals import ARGUMENT_ERROR, TURN, Array, Span, direction, length, unsigned
from tailor.models.features.sight_intervals import Case, Spans, may_lie_in_half, sight, wrapped

LENGTH_ERROR = 1e-5  # m: products of coordinates and directions in single precision


def one_obstacle(columns: Spans) -> tuple[Case, ...]:
    """Ranges of the features for boxes of poses and of obstacles."""
    x, y, phi, v, xg, yg, phig, vg, place_x, place_y, radius = columns
    line = sight(x, y, xg, yg)
    to, way = line - phi, length(xg - x, yg - y)
    offset, offset_g = (place_x - x, place_y - y), (place_x - xg, place_y - yg)
    bearing, away = direction(*offset), length(*offset)
    along, across = (_component(away, bearing - line, quarter) for quarter in (0.0, np.pi / 2))
    known = v, vg, way, unsigned(to)
    beside = (
        _clear_way(x, y, xg, yg, place_x, place_y, radius),
        (away - radius).wider(LENGTH_ERROR),
        (length(*offset_g) - radius).wider(LENGTH_ERROR),
        unsigned(bearing - phi),
        unsigned(direction(*offset_g) - phig),
    )
    left, right = may_lie_in_half(to, 0.0), may_lie_in_half(to, -np.pi)
    cases = []
    for at, beyond in wrapped(phig - line):
        cases += [Case((*known, at, along, across, *beside), left & beyond)]
        cases += [Case((*known, -at, along, -across, *beside), right & beyond)]
    return tuple(cases)


def _component(away: Span, angle: Span, quarter: float) -> Span:
    """Component of a vector along a direction, or across it a quarter turn to the left."""
    least, most = _cosines(angle.lower - quarter, angle.upper - quarter)
    shortest = np.maximum(away.lower, 0.0)
    lower = np.minimum(least * shortest, least * away.upper)
    upper = np.maximum(most * shortest, most * away.upper)
    return Span(lower, upper).wider(LENGTH_ERROR)


def _cosines(lower: Array, upper: Array) -> tuple[Array, Array]:
    """Minimum and maximum of the cosine between two angles."""
    ends = np.cos(lower), np.cos(upper)
    opposite = np.floor((upper - np.pi) / TURN) >= np.ceil((lower - np.pi) / TURN)
    ahead = np.floor(upper / TURN) >= np.ceil(lower / TURN)
    return np.where(opposite, -1.0, np.minimum(*ends)), np.where(ahead, 1.0, np.maximum(*ends))


def _clear_way(x: Span, y: Span, xg: Span, yg: Span, place_x: Span, place_y: Span, radius: Span) -> Span:
    """Distance of a disc from the straight way: that of the middles of the boxes, plus or minus their half diagonals.

    The distance of a point from a segment changes by at most the larger displacement of the segment's two ends.
    """
    ends = [_middle(span) for span in (x, y, xg, yg, place_x, place_y)]
    middle = _distance_from_segment(*ends)
    moved = np.maximum(_half_diagonal(x, y), _half_diagonal(xg, yg)) + _half_diagonal(place_x, place_y)
    return (Span(middle - moved, middle + moved) - radius).wider(LENGTH_ERROR + ARGUMENT_ERROR)


def _distance_from_segment(x: Array, y: Array, xg: Array, yg: Array, place_x: Array, place_y: Array) -> Array:
    """Distance of places from the segments between (x, y) and (xg, yg)."""
    dx, dy = xg - x, yg - y
    share = ((place_x - x) * dx + (place_y - y) * dy) / np.maximum(dx * dx + dy * dy, 1e-300)
    share = np.clip(share, 0.0, 1.0)
    distance: Array = np.hypot(place_x - x - share * dx, place_y - y - share * dy)
    return distance


def _middle(span: Span) -> Array:
    return (span.lower + span.upper) / 2


def _half_diagonal(x: Span, y: Span) -> Array:
    diagonal: Array = np.hypot(x.upper - x.lower, y.upper - y.lower)
    return diagonal / 2
