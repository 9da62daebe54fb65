"""Search space of the free parameters: a box with periodic dimensions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.sequence import Variable


@dataclass(frozen=True, slots=True)
class Ranges:
    """Ranges of d free parameters: `lower`, `upper` and `periodic`, each of shape (d,)."""

    lower: Array
    upper: Array
    periodic: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """Number of free parameters, d."""
        return len(self.lower)

    @property
    def width(self) -> Array:
        """Upper minus lower, shape (d,)."""
        return self.upper - self.lower

    def confine(self, candidates: Array) -> Array:
        """Candidates, shape (n, d), moved into the ranges: angles are wrapped, all others are clipped."""
        confined: Array = np.minimum(np.maximum(candidates, self.lower), self.upper)
        periodic = np.flatnonzero(self.periodic)
        if len(periodic):
            lower, upper = self.lower[periodic], self.upper[periodic]
            wrapped = lower + np.mod(candidates[:, periodic] - lower, upper - lower)
            confined[:, periodic] = np.minimum(wrapped, upper)  # rounding may exceed the upper end by one bit
        return confined

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Uniform candidates, shape (count, d), one from each of `count` strata of every parameter."""
        strata = rng.permuted(np.tile(np.arange(count), (self.count, 1)), axis=1).T
        return self.lower + self.width * (strata + rng.random((count, self.count))) / count

    def part(self, columns: NDArray[np.intp]) -> Ranges:
        """Ranges of a subset of the parameters, by column."""
        return Ranges(self.lower[columns], self.upper[columns], self.periodic[columns])


def ranges_of(variables: Iterable[Variable]) -> Ranges:
    """Ranges of free variables, in the given order."""
    listed = tuple(variables)
    return Ranges(
        np.array([variable.lower for variable in listed], dtype=np.float64),
        np.array([variable.upper for variable in listed], dtype=np.float64),
        np.array([variable.periodic for variable in listed], dtype=np.bool_),
    )
