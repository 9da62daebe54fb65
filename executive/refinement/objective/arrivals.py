"""Where the robot really is when it has arrived at a subgoal: a fixed design of small displacements.

What is optimal only when hit exactly is not optimal, so the cost after a subgoal is averaged over these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tailor.executive.interfaces.values import Array


def displacements(quantities: Sequence[str], spread: Mapping[str, float]) -> Array:
    """Displacements of arrival, shape (m, q), the first all zero; m is 1 where nothing is displaced.

    For r displaced quantities there are r + 1 more, the corners of a regular simplex: the fewest points that have the
    mean and the covariance of the spread. The simplex is turned so that every corner displaces all quantities.

    Args:
      quantities: The quantities of the arrival's parameters, length q.
      spread: Standard deviation by quantity, in its unit; a quantity that is missing is hit exactly.
    """
    deviations = np.array([spread.get(quantity, 0.0) for quantity in quantities], dtype=np.float64)
    displaced = np.flatnonzero(deviations > 0)
    count = len(displaced)
    if count == 0:
        return np.zeros((1, len(quantities)))
    points = np.zeros((count + 2, len(quantities)))
    radius = np.sqrt(count * (count + 2) / (count + 1))  # all count + 2 points weigh the same
    points[1:, displaced] = radius * _simplex(count) * deviations[displaced]
    return points


def _simplex(count: int) -> Array:
    """Corners of a regular simplex on the unit sphere, shape (count + 1, count), none of them along an axis."""
    angle = 2 * np.pi * np.outer(np.arange(count + 1), np.arange(count + 1)) / (count + 1)
    orthogonal = (np.cos(angle) + np.sin(angle)) / np.sqrt(count + 1)  # the discrete Hartley transform
    corners: Array = orthogonal[:, 1:] * np.sqrt((count + 1) / count)
    return corners
