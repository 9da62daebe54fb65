"""Deviation of the robot from a subgoal on arrival: a fixed design of small displacements.

A choice that is optimal only at the exact subgoal is not robust, so the cost is averaged over these displacements.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tailor.executive.interfaces.values import Array


def displacements(quantities: Sequence[str], std: Mapping[str, float]) -> Array:
    """Displacements on arrival; the first one is zero.

    For r displaced quantities there are r + 1 more, the corners of a regular simplex. These are the fewest points with
    the mean and the covariance of the deviation. The simplex is rotated so that every corner displaces all quantities.

    Args:
      quantities: Quantities of the parameters at the arrival, length q.
      std: Standard deviation by quantity, in its unit; a quantity that is missing is reached exactly.

    Returns:
      Displacements, shape (m, q); m is 1 if no quantity is displaced.
    """
    deviations = np.array([std.get(quantity, 0.0) for quantity in quantities], dtype=np.float64)
    displaced = np.flatnonzero(deviations > 0)
    count = len(displaced)
    if count == 0:
        return np.zeros((1, len(quantities)))
    points = np.zeros((count + 2, len(quantities)))
    radius = np.sqrt(count * (count + 2) / (count + 1))  # all count + 2 points have the same weight
    points[1:, displaced] = radius * _simplex(count) * deviations[displaced]
    return points


def _simplex(count: int) -> Array:
    """Corners of a regular simplex on the unit sphere, shape (count + 1, count), none of them along an axis."""
    angle = 2 * np.pi * np.outer(np.arange(count + 1), np.arange(count + 1)) / (count + 1)
    orthogonal = (np.cos(angle) + np.sin(angle)) / np.sqrt(count + 1)  # the discrete Hartley transform
    corners: Array = orthogonal[:, 1:] * np.sqrt((count + 1) / count)
    return corners
