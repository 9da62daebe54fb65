"""Intervals of numbers, many at once, and the few operations that features of poses need of them.

Results are rounded outward by more than single precision and our arctangent are off: what a model computes lies inside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ARGUMENT_ERROR = 2e-6  # m (or rad, m/s): a field's coordinates in single precision, and their differences
ANGLE_ERROR = 1e-6  # rad: sums of angles in single precision, and whole turns taken off them
ARCTANGENT_ERROR = 1.1e-5  # rad: that of the features is 1e-5 off
TURN = 2 * np.pi
NEAR = 1e-3  # m: nearer, the line of sight is taken to have any direction


@dataclass(frozen=True, slots=True)
class Span:
    """Numbers between `lower` and `upper`, arrays whose shapes broadcast against those of other spans."""

    lower: Array
    upper: Array

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where there is one number only."""
        return np.asarray(self.lower == self.upper)

    def __sub__(self, other: Span) -> Span:
        return Span(self.lower - other.upper, self.upper - other.lower)

    def __neg__(self) -> Span:
        return Span(-self.upper, -self.lower)

    def hull(self, other: Span) -> Span:
        """The numbers of both, and those between them."""
        if other is self:
            return self
        return Span(np.minimum(self.lower, other.lower), np.maximum(self.upper, other.upper))

    def wider(self, by: Array | float) -> Span:
        """With a margin on both sides."""
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
    """Angles of (dx, dy), at most a half turn wide, not brought into [-pi, pi]; a whole turn where (0, 0) is near."""
    middle = np.arctan2(dy.lower + dy.upper, dx.lower + dx.upper)
    corners = [(x, y) for x in (dx.lower, dx.upper) for y in (dy.lower, dy.upper)]
    off = [turned(np.arctan2(y, x) - middle) for x, y in corners]
    nearest = length(dx, dy).lower
    margin = ARCTANGENT_ERROR + ARGUMENT_ERROR / np.maximum(nearest, NEAR)
    least, most = np.minimum.reduce(off) - margin, np.maximum.reduce(off) + margin
    near = nearest < NEAR
    return Span(np.where(near, -np.pi, middle + least), np.where(near, np.pi, middle + most))


def turned(angle: Array) -> Array:
    """Angles brought into [-pi, pi] by whole turns."""
    return angle - TURN * np.round(angle / TURN)


def unsigned(angle: Span) -> Span:
    """Magnitudes of the angles brought into [-pi, pi]."""
    wide = angle.wider(ANGLE_ERROR)
    ends = np.abs(turned(wide.lower)), np.abs(turned(wide.upper))
    ahead = np.floor(wide.upper / TURN) >= np.ceil(wide.lower / TURN)
    behind = np.floor((wide.upper - np.pi) / TURN) >= np.ceil((wide.lower - np.pi) / TURN)
    return Span(np.where(ahead, 0.0, np.minimum(*ends)), np.where(behind, np.pi, np.maximum(*ends)))
