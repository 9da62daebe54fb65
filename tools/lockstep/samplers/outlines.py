"""Distances of the kitchen robot, its arm folded, from upright boxes and cylinders, by their outlines on the floor."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M

OVER_TOP_M = 1.03  # what is higher may be touched by the hand, too
# Rectangles of the folded forearm with the palm, and of the open gripper: from, to ahead of the middle, and half width
HAND_M = ((0.30, 0.52, 0.075), (0.52, 0.61, 0.072))
OUTREACH_M = 0.15  # what the hand adds to the room that a box is drawn in
X, Y, PHI, LONG, WIDE, MARGIN, HIGH = range(7)  # columns of an object


def clearances(poses: Array, row: Array) -> Array:
    """Distance at each pose (x, y, phi), shape (n, 3), from an object; negative where they overlap. Shape (n,).

    Args:
      poses: Of the base, m and rad, map frame.
      row: Centre, direction, half length, half width, margin and height of the object; see the context of goToPose.
    """
    c, s = np.cos(row[PHI]), np.sin(row[PHI])
    dx, dy = poses[:, 0] - row[X], poses[:, 1] - row[Y]
    seen = np.stack([c * dx + s * dy, c * dy - s * dx, poses[:, 2] - row[PHI]])
    parts = [_base(seen, row) - BASE_RADIUS_M]
    if row[HIGH] > OVER_TOP_M:
        parts += [_rectangle(seen, row, *part) for part in HAND_M]
    nearest: Array = np.minimum.reduce(parts) - row[MARGIN]
    return nearest


def _base(seen: Array, row: Array) -> Array:
    """Distance of the base's middle from the rectangle."""
    dx, dy = np.abs(seen[0]) - row[LONG], np.abs(seen[1]) - row[WIDE]
    outside = np.hypot(np.maximum(dx, 0.0), np.maximum(dy, 0.0))
    distance: Array = outside + np.minimum(np.maximum(dx, dy), 0.0)
    return distance


def _rectangle(seen: Array, row: Array, start: float, end: float, half: float) -> Array:
    """Distance of two rectangles along the axis that separates them best, a lower bound of their distance."""
    x, y, phi = seen
    c, s = np.cos(phi), np.sin(phi)
    long, wide, reach, middle = row[LONG], row[WIDE], (end - start) / 2, (start + end) / 2
    x, y = x + c * middle, y + s * middle
    along, across = np.abs(c), np.abs(s)
    axes = (
        np.abs(x) - long - along * reach - across * half,
        np.abs(y) - wide - across * reach - along * half,
        np.abs(c * x + s * y) - reach - along * long - across * wide,
        np.abs(c * y - s * x) - half - across * long - along * wide,
    )
    distance: Array = np.maximum.reduce(axes)
    return distance
