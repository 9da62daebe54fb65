"""Where the robot really is when it has arrived at a subgoal: a fixed design of small displacements.

What is optimal only when hit exactly is not optimal, so the cost after a subgoal is averaged over these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from executive.library import Array


def displacements(quantities: Sequence[str], spread: Mapping[str, float]) -> Array:
    """Displacements of arrival, shape (m, q), the first all zero; m is 1 where nothing is displaced.

    For r displaced quantities there are 2 r more: the sigma points of a normal distribution (plus and minus sqrt(r)
    standard deviations along orthogonal directions), which have its mean and covariance. The directions are turned
    so that each point displaces all quantities a little, not one by a lot.

    Args:
      quantities: The quantities of the arrival's parameters, length q.
      spread: Standard deviation by quantity, in its unit; a quantity that is missing is hit exactly.
    """
    deviations = np.array([spread.get(quantity, 0.0) for quantity in quantities], dtype=np.float64)
    displaced = np.flatnonzero(deviations > 0)
    count = len(displaced)
    if count == 0:
        return np.zeros((1, len(quantities)))
    points = np.zeros((1 + 2 * count, len(quantities)))
    directions = _turned_axes(count) * np.sqrt(count)
    points[1::2, displaced] = directions * deviations[displaced]
    points[2::2, displaced] = -directions * deviations[displaced]
    return points


def _turned_axes(count: int) -> Array:
    """An orthogonal matrix without zeros to speak of: the discrete Hartley transform, shape (count, count)."""
    angle = 2 * np.pi * np.outer(np.arange(count), np.arange(count)) / count
    matrix: Array = (np.cos(angle) + np.sin(angle)) / np.sqrt(count)
    return matrix
