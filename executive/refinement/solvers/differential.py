"""Differential evolution, one vectorised generation for each check: for sequences that form no chain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.solver import Limits, Objective, Solver

INDIVIDUALS_PER_PARAMETER = 5  # few individuals, most of them attracted to the best: time allows 60 generations only
MIN_INDIVIDUALS = 24
CROSSOVER = 0.8
MIN_STEP, MAX_STEP = 0.4, 0.9  # weight of the difference, drawn for every child: dither avoids stagnation
TO_BEST_SHARE = 0.8  # children that start part of the way to the best; the others start at their own parent


@dataclass(frozen=True, slots=True)
class Crowd:
    """Individuals of a population, and the share of their children that are attracted to the best one.

    The default ends early in one basin. A large crowd whose children mostly stay where they are covers several.
    """

    size: int = MIN_INDIVIDUALS
    to_best_share: float = TO_BEST_SHARE


class DifferentialEvolution(Solver):
    """Each individual competes with one child: itself, moved by the difference of two others.

    Args:
      objective: Cost to minimise.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d).
      limits: End of the search, in generations.
      crowd: Population; it has at least five individuals a parameter.
    """

    def __init__(
        self,
        objective: Objective,
        rng: np.random.Generator,
        seeds: Array,
        limits: Limits,
        crowd: Crowd = Crowd(),
    ) -> None:
        super().__init__(objective, rng, seeds, limits)
        self._size = max(crowd.size, INDIVIDUALS_PER_PARAMETER * objective.ranges.count)
        self._to_best_share = crowd.to_best_share
        self._population: Array | None = None
        self._costs = np.empty(0)
        self._periodic = np.flatnonzero(objective.ranges.periodic)
        self._period = objective.ranges.width[self._periodic]

    @property
    def elite(self) -> Array:
        """See Solver: half of the population, so that a search that begins with it looks elsewhere, too."""
        if self._population is None:
            return super().elite
        cheapest = np.argsort(self._costs, kind="stable")[: self._size // 2]
        return self._population[cheapest[np.isfinite(self._costs[cheapest])]]

    def _check(self) -> None:
        if self._population is None:
            self._population = np.vstack([self._seeds, self._objective.ranges.draw(self._size, self._rng)])[
                : self._size
            ]
            self._costs = self._objective(self._population)
        else:
            self._select(self._population)
        self._consider_all(self._population, self._costs)

    def _select(self, population: Array) -> None:
        """Replace each individual if its child is at least as good; any child replaces an INVALID individual."""
        children = self._children(population)
        costs = self._objective(children)
        better = costs <= self._costs
        population[better] = children[better]
        self._costs[better] = costs[better]

    def _children(self, population: Array) -> Array:
        """One child for each individual, shape (n, d)."""
        count, genes = population.shape
        others = self._rng.integers(0, count, size=(2, count))
        step = self._rng.uniform(MIN_STEP, MAX_STEP, (count, 1))
        difference = step * self._wrap(population[others[0]] - population[others[1]])
        to_best = (self._rng.random((count, 1)) < self._to_best_share) * step
        leader = population[int(np.argmin(self._costs))]
        mutant = population + to_best * self._wrap(leader - population) + difference
        crossed = self._rng.random((count, genes)) < CROSSOVER
        crossed[np.arange(count), self._rng.integers(0, genes, size=count)] = True
        return self._objective.ranges.confine(np.where(crossed, mutant, population))

    def _wrap(self, difference: Array) -> Array:
        """Differences with angles wrapped to the shorter direction."""
        if len(self._periodic):
            angles = difference[:, self._periodic]
            difference[:, self._periodic] = np.mod(angles + self._period / 2, self._period) - self._period / 2
        return difference
