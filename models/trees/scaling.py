"""Standardisation of features and targets for fitting; undone when a tree is converted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Scale:
    """Zero mean and unit deviation of features and targets."""

    centre: Array  # (f,)
    width: Array  # (f,)
    y_centre: float
    y_width: float

    @classmethod
    def of(cls, features: Array, targets: Array) -> Scale:
        """The scale that gives zero mean and unit deviation; constant columns keep their width."""
        width, y_width = features.std(axis=0), float(targets.std())
        return cls(features.mean(axis=0), np.where(width > 1e-12, width, 1.0), float(targets.mean()), y_width or 1.0)

    def raw(self, solution: Array) -> tuple[Array, float]:
        """Slopes and intercept in the features' and the targets' own units."""
        slopes = solution[:-1] / self.width * self.y_width
        return slopes, float(solution[-1] * self.y_width + self.y_centre - slopes @ self.centre)
