"""Boxes of a subgoal's free parameters, and their bisection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import Ranges


@dataclass(frozen=True, slots=True)
class Boxes:
    """n boxes of the d free parameters of one subgoal: `lower` and `upper` have shape (n, d)."""

    lower: Array
    upper: Array

    def __len__(self) -> int:
        return len(self.lower)

    @property
    def width(self) -> Array:
        """Shape (n, d)."""
        return self.upper - self.lower

    @property
    def radius(self) -> Array:
        """Half of the width, shape (n, d)."""
        return (self.upper - self.lower) / 2

    @property
    def middle(self) -> Array:
        """Shape (n, d)."""
        return (self.lower + self.upper) / 2

    def part(self, indices: NDArray[np.intp]) -> Boxes:
        """Subset of the boxes."""
        return Boxes(self.lower[indices], self.upper[indices])

    def halves(self, weight: Array) -> Boxes:
        """Each box bisected along its longest side by `weight`, (d,): all lower halves, then all upper ones."""
        side = np.argmax(self.width * weight, axis=1)
        rows = np.arange(len(self))
        lower, upper = self.lower.copy(), self.upper.copy()
        upper[rows, side] = lower[rows, side] = self.middle[rows, side]
        return Boxes(np.vstack([self.lower, lower]), np.vstack([upper, self.upper]))


NO_PARAMETERS = Boxes(np.empty((1, 0)), np.empty((1, 0)))  # nothing is free: one box without dimensions


def box_of(ranges: Ranges) -> Boxes:
    """All of the ranges as one box."""
    return Boxes(ranges.lower[None], ranges.upper[None])


def joined(first: Boxes, second: Boxes) -> Boxes:
    """The boxes of both."""
    return Boxes(np.vstack([first.lower, second.lower]), np.vstack([first.upper, second.upper]))
