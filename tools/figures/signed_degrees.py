"""Angles of polar plots from -180° to 180°, as all other output has them."""

from __future__ import annotations

from typing import Any

STEP = 45


def count_both_ways(axis: Any) -> None:
    """Label a polar axis from -135° to 180° instead of 0° to 315°."""
    degrees = range(STEP - 180, 181, STEP)
    axis.set_thetagrids([degree % 360 for degree in degrees], [f"{degree}°" for degree in degrees])
