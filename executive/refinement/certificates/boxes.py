"""Boxes of a subgoal's free parameters, and how they are cut."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

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
    def middle(self) -> Array:
        """Shape (n, d)."""
        return (self.lower + self.upper) / 2

    def part(self, index: Any) -> Boxes:
        """Some of them."""
        return Boxes(self.lower[index], self.upper[index])

    def halves(self, weight: Array) -> Boxes:
        """Each cut in the middle of the side that is longest by `weight`, (d,): lower halves first, then upper ones."""
        side = np.argmax(self.width * weight, axis=1)
        rows = np.arange(len(self))
        lower, upper = self.lower.copy(), self.upper.copy()
        upper[rows, side] = lower[rows, side] = self.middle[rows, side]
        return Boxes(np.vstack([self.lower, lower]), np.vstack([upper, self.upper]))


NOWHERE = Boxes(np.empty((1, 0)), np.empty((1, 0)))  # where nothing is free: one box without sides


def box_of(ranges: Ranges) -> Boxes:
    """All of the ranges as one box."""
    return Boxes(ranges.lower[None], ranges.upper[None])


def joined(first: Boxes, second: Boxes) -> Boxes:
    """The boxes of both."""
    return Boxes(np.vstack([first.lower, second.lower]), np.vstack([first.upper, second.upper]))
