"""The feature spaces of a spot as seen from a pose, in interval arithmetic; see `kitchen/spots.py`."""

from __future__ import annotations

from tailor.models.features.intervals import ANGLE_ERROR, TURN, Span, length, magnitude, unsigned
from tailor.models.features.sight_intervals import Case, Spans, may_lie_in_half, sight


def spot(columns: Spans) -> tuple[Case, ...]:
    """Ranges of the features for boxes of poses and spots."""
    return _seen(columns, ())


def spot_out(columns: Spans) -> tuple[Case, ...]:
    """Also whether the arm is out."""
    return _seen(columns, columns[6:7])


def spot_handle(columns: Spans) -> tuple[Case, ...]:
    """Also how far the handle is off the direction of the hand."""
    x, y, _, spot_x, spot_y, aside, out, handle = columns
    off = handle - sight(x, y, spot_x, spot_y) - aside
    return _seen(columns, (out, unsigned(off.wider(ANGLE_ERROR))))


def _seen(columns: Spans, further: tuple[Span, ...]) -> tuple[Case, ...]:
    """The spot to the left of the robot's heading, and to the right."""
    x, y, phi, spot_x, spot_y, aside = columns[:6]
    bearing = sight(x, y, spot_x, spot_y) - phi
    known = length(spot_x - x, spot_y - y), unsigned(bearing), magnitude(aside)
    left, right = may_lie_in_half(bearing, 0.0), may_lie_in_half(bearing, -TURN / 2)
    return Case((*known, aside, *further), left), Case((*known, -aside, *further), right)
