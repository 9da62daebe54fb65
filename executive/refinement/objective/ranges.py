"""The search space: a box, some of whose sides wrap around."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.sequence import Variable


@dataclass(frozen=True, slots=True)
class Ranges:
    """Where the free parameters may lie: `lower`, `upper` and `periodic`, each of shape (d,)."""

    lower: Array
    upper: Array
    periodic: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """The number of free parameters, d."""
        return len(self.lower)

    @property
    def width(self) -> Array:
        """Upper minus lower, shape (d,)."""
        return self.upper - self.lower

    def confine(self, candidates: Array) -> Array:
        """Candidates, shape (n, d), brought into the ranges: angles wrap, the rest stops at the end."""
        confined: Array = np.minimum(np.maximum(candidates, self.lower), self.upper)
        turning = np.flatnonzero(self.periodic)
        if len(turning):
            lower, upper = self.lower[turning], self.upper[turning]
            turned = lower + np.mod(candidates[:, turning] - lower, upper - lower)
            confined[:, turning] = np.minimum(turned, upper)  # rounding may put it a hair beyond the end
        return confined

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Uniform candidates, shape (count, d), one from each of `count` layers of every parameter."""
        layers = rng.permuted(np.tile(np.arange(count), (self.count, 1)), axis=1).T
        return self.lower + self.width * (layers + rng.random((count, self.count))) / count

    def contain(self, candidates: Array) -> bool:
        """Whether every candidate, shape (n, d), lies within the ranges."""
        return bool(np.all((candidates >= self.lower) & (candidates <= self.upper)))

    def part(self, columns: NDArray[np.intp]) -> Ranges:
        """The ranges of some of the parameters, by column."""
        return Ranges(self.lower[columns], self.upper[columns], self.periodic[columns])


def ranges_of(variables: Iterable[Variable]) -> Ranges:
    """The ranges of free variables, in their order."""
    listed = tuple(variables)
    return Ranges(
        np.array([variable.lower for variable in listed], dtype=np.float64),
        np.array([variable.upper for variable in listed], dtype=np.float64),
        np.array([variable.periodic for variable in listed], dtype=np.bool_),
    )
