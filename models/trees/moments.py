"""Second moments of examples, and the linear fits that they determine.

A set of rows has the moments M = Σ w z zᵀ with z = (x_1 .. x_f, 1, y). Moments of disjoint sets add, so every split of
a node is evaluated from running sums. Only the upper triangle is stored ("packed").
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def row_products(features: Array, targets: Array, weights: Array) -> Array:
    """Packed w z zᵀ of every row: features (n, f), targets and weights (n,) to shape (n, q)."""
    z = np.column_stack([features, np.ones(len(features)), targets])
    first, second = np.triu_indices(z.shape[1])
    return z[:, first] * z[:, second] * weights[:, None]


def unpack(packed: Array, features: int) -> Array:
    """Full symmetric matrices, shape (..., f + 2, f + 2), of packed ones, shape (..., q)."""
    size = features + 2
    where = np.zeros((size, size), np.intp)
    first, second = np.triu_indices(size)
    where[first, second] = where[second, first] = np.arange(len(first))
    return packed[..., where]


def fit(moments: Array, ridge: float) -> tuple[Array, Array]:
    """Least squares with a small ridge on the slopes.

    Args:
      moments: Full matrices, shape (..., f + 2, f + 2).
      ridge: Penalty on squared slopes, relative to the number of rows (features are standardised).

    Returns:
      Coefficients (..., f + 1), slopes then intercept, and the sum of squared errors (...,).
    """
    gram, cross, squares = moments[..., :-1, :-1], moments[..., :-1, -1], moments[..., -1, -1]
    size = gram.shape[-1]
    count = np.maximum(gram[..., -1, -1], 1e-12)
    penalty = np.zeros((size, size))
    np.fill_diagonal(penalty[:-1, :-1], ridge)
    penalty[-1, -1] = 1e-12
    solution = np.linalg.solve(gram + penalty * count[..., None, None], cross[..., None])[..., 0].astype(np.float64)
    explained = np.einsum("...i,...ij,...j->...", solution, gram, solution)
    return solution, np.maximum(squares - 2 * np.sum(cross * solution, -1) + explained, 0.0)
