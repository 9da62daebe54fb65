"""Angles in radians, normalised to [-pi, pi]."""

from __future__ import annotations

import math


def wrap(angle: float) -> float:
    """The same angle in [-pi, pi]."""
    return math.remainder(angle, math.tau)


def difference(a: float, b: float) -> float:
    """The signed turn from b to a, in [-pi, pi]."""
    return math.remainder(a - b, math.tau)
