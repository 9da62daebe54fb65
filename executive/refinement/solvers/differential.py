"""Differential evolution, one vectorised generation a check: for sequences whose parameters form no chain."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.solver import Limits, Objective, Solver

INDIVIDUALS_PER_PARAMETER = 5  # few, and most of them after the best: there is time for some 60 generations only
INDIVIDUALS_MIN = 24
CROSSOVER = 0.8
STEP_MIN, STEP_MAX = 0.4, 0.9  # the difference's weight, drawn for every child: dither avoids stagnation
TO_BEST_SHARE = 0.8  # children that start half way to the best, the others from their own parent


class DifferentialEvolution(Solver):
    """Each individual is challenged by one child: itself, moved by the difference of two others.

    Args:
      objective: What is minimised.
      rng: The only source of randomness.
      seeds: Candidates to begin with, shape (s, d).
      limits: When the search is finished, in generations.
    """

    def __init__(self, objective: Objective, rng: np.random.Generator, seeds: Array, limits: Limits) -> None:
        super().__init__(objective, rng, seeds, limits)
        self._size = max(INDIVIDUALS_MIN, INDIVIDUALS_PER_PARAMETER * objective.ranges.count)
        self._population: Array | None = None
        self._costs = np.empty(0)
        self._turning = np.flatnonzero(objective.ranges.periodic)
        self._turn = objective.ranges.width[self._turning]

    def _check(self) -> None:
        if self._population is None:
            self._population = np.vstack([self._seeds, self._objective.ranges.draw(self._size, self._rng)])[
                : self._size
            ]
            self._costs = self._objective(self._population)
        else:
            self._challenge(self._population)
        self._consider_all(self._population, self._costs)

    def _challenge(self, population: Array) -> None:
        """Replace the individuals whose child is at least as good; what is INVALID is replaced by anything."""
        children = self._children(population)
        costs = self._objective(children)
        better = costs <= self._costs
        population[better] = children[better]
        self._costs[better] = costs[better]

    def _children(self, population: Array) -> Array:
        """One child an individual, shape (n, d)."""
        count, genes = population.shape
        others = self._rng.integers(0, count, size=(2, count))
        step = self._rng.uniform(STEP_MIN, STEP_MAX, (count, 1))
        difference = step * self._shortest(population[others[0]] - population[others[1]])
        to_best = (self._rng.random((count, 1)) < TO_BEST_SHARE) * step
        leader = population[int(np.argmin(self._costs))]
        moved = population + to_best * self._shortest(leader - population) + difference
        crossed = self._rng.random((count, genes)) < CROSSOVER
        crossed[np.arange(count), self._rng.integers(0, genes, size=count)] = True
        return self._objective.ranges.confine(np.where(crossed, moved, population))

    def _shortest(self, difference: Array) -> Array:
        """Differences with the angles taken the short way round."""
        if len(self._turning):
            angles = difference[:, self._turning]
            difference[:, self._turning] = np.mod(angles + self._turn / 2, self._turn) - self._turn / 2
        return difference
