"""Arrays of intervals, with the operations that features of poses need.

Results are rounded outward by more than the error of single precision and of our arctangent.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ARGUMENT_ERROR = 2e-6  # m (or rad, m/s): a field's coordinates in single precision, and their differences
ANGLE_ERROR = 1e-6  # rad: sums of angles in single precision, wrapped
ARCTANGENT_ERROR = 1.1e-5  # rad: that of the features is 1e-5 off
TURN = 2 * np.pi
NEAR = 1e-3  # m: below this distance the line of sight may have any direction


@dataclass(frozen=True, slots=True)
class Span:
    """Numbers between `lower` and `upper`, arrays whose shapes broadcast against those of other spans."""

    lower: Array
    upper: Array

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where the interval is a single number."""
        return np.asarray(self.lower == self.upper)

    def __sub__(self, other: Span) -> Span:
        return Span(self.lower - other.upper, self.upper - other.lower)

    def __neg__(self) -> Span:
        return Span(-self.upper, -self.lower)

    def hull(self, other: Span) -> Span:
        """Smallest interval that contains both."""
        if other is self:
            return self
        return Span(np.minimum(self.lower, other.lower), np.maximum(self.upper, other.upper))

    def hull_of_copies(self) -> Span:
        """Smallest interval that contains all along the first axis, which stays."""
        return Span(self.lower.min(axis=0, keepdims=True), self.upper.max(axis=0, keepdims=True))

    def wider(self, by: Array | float) -> Span:
        """The interval with a margin on both sides."""
        return Span(self.lower - by, self.upper + by)


def magnitude(span: Span) -> Span:
    """Absolute values."""
    across = (span.lower <= 0) & (span.upper >= 0)
    ends = np.abs(span.lower), np.abs(span.upper)
    return Span(np.where(across, 0.0, np.minimum(*ends)), np.maximum(*ends))


def length(dx: Span, dy: Span) -> Span:
    """Euclidean lengths of (dx, dy)."""
    x, y = magnitude(dx), magnitude(dy)
    lower, upper = np.hypot(x.lower, y.lower), np.hypot(x.upper, y.upper)
    return Span(lower - ARGUMENT_ERROR, upper + ARGUMENT_ERROR)


def direction(dx: Span, dy: Span) -> Span:
    """Angles of (dx, dy), at most a half turn wide, not wrapped to [-pi, pi]; a whole turn where (0, 0) is near."""
    middle = np.arctan2(dy.lower + dy.upper, dx.lower + dx.upper)
    corners = [(x, y) for x in (dx.lower, dx.upper) for y in (dy.lower, dy.upper)]
    off = [wrap(np.arctan2(y, x) - middle) for x, y in corners]
    nearest = length(dx, dy).lower
    margin = ARCTANGENT_ERROR + ARGUMENT_ERROR / np.maximum(nearest, NEAR)
    least, most = np.minimum.reduce(off) - margin, np.maximum.reduce(off) + margin
    near = nearest < NEAR
    return Span(np.where(near, -np.pi, middle + least), np.where(near, np.pi, middle + most))


def wrap(angle: Array) -> Array:
    """Angles wrapped to [-pi, pi]."""
    return angle - TURN * np.round(angle / TURN)


def unsigned(angle: Span) -> Span:
    """Absolute values of the angles wrapped to [-pi, pi]."""
    wide = angle.wider(ANGLE_ERROR)
    ends = np.abs(wrap(wide.lower)), np.abs(wrap(wide.upper))
    ahead = np.floor(wide.upper / TURN) >= np.ceil(wide.lower / TURN)
    behind = np.floor((wide.upper - np.pi) / TURN) >= np.ceil((wide.lower - np.pi) / TURN)
    return Span(np.where(ahead, 0.0, np.minimum(*ends)), np.where(behind, np.pi, np.maximum(*ends)))


def triangle(angle: Span) -> Span:
    """The triangle wave that follows the sine: from angles in [-pi, pi] to [-pi / 2, pi / 2]."""
    wide = angle.wider(ANGLE_ERROR)
    ends = [np.abs(end + np.pi / 2) - np.abs(end - np.pi / 2) - end for end in (wide.lower, wide.upper)]
    lowest = (wide.lower <= -np.pi / 2) & (wide.upper >= -np.pi / 2)
    highest = (wide.lower <= np.pi / 2) & (wide.upper >= np.pi / 2)
    lower = np.where(lowest, -np.pi / 2, np.minimum(*ends))
    upper = np.where(highest, np.pi / 2, np.maximum(*ends))
    return Span(lower - 2 * ANGLE_ERROR, upper + 2 * ANGLE_ERROR)
