"""The paper's genetic algorithm (6.2.2), unmodified: the baseline for every other solver."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.random_scales import random_scales
from tailor.executive.refinement.solvers.solver import Limits, Objective, Solver

CHROMOSOMES_PER_PARAMETER = 25
ELITE = 0.02  # share that passes to the next generation unmodified
CROSSOVER = 0.65  # share of individuals from two-point crossover
MAX_IDLE_GENERATIONS = 50
MAX_GENERATIONS = 500
# The paper does not define its mutation. Here one gene of a child moves by a normal step. The scale is drawn anew, from
# 10**-4 to all of its range, so that early steps explore and late ones converge. Of four variants it came closest to
# the minima of De Jong, Schwefel and Ackley (median of 30 seeds: 2e-7, 1e-4, 5e-3 in three dimensions).
MUTATION_DECADES = 4.0


class GeneticAlgorithm(Solver):
    """One generation for each check: elitism, mutation, two-point crossover, fitness-proportionate selection.

    Args:
      objective: Cost to minimise.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d).
      generations_max: Maximum number of generations.
    """

    def __init__(
        self, objective: Objective, rng: np.random.Generator, seeds: Array, generations_max: int = MAX_GENERATIONS
    ) -> None:
        super().__init__(objective, rng, seeds, Limits(MAX_IDLE_GENERATIONS, generations_max))
        self._size = CHROMOSOMES_PER_PARAMETER * objective.ranges.count
        self._population: Array | None = None
        self._costs = np.empty(0)

    def _check(self) -> None:
        previous = self._population
        population = self._initial_population() if previous is None else self._next_population(previous)
        self._population = population
        self._costs = self._objective(population)
        self._consider_all(population, self._costs)

    def _initial_population(self) -> Array:
        """Random values from the ranges, after the given seeds; shape (25 d, d)."""
        ranges = self._objective.ranges
        random = ranges.lower + ranges.width * self._rng.random((self._size, ranges.count))
        return np.vstack([self._seeds, random])[: self._size]

    def _next_population(self, population: Array) -> Array:
        """The next generation, the elite first."""
        elite_count = max(1, round(ELITE * self._size))
        elite = population[np.argsort(self._costs, kind="stable")[:elite_count]]
        probabilities = self._selection_probabilities()
        parents = self._rng.choice(self._size, size=(2, self._size - elite_count), p=probabilities)
        children = self._cross(population[parents[0]], population[parents[1]])
        return np.vstack([elite, self._mutate(children)])

    def _selection_probabilities(self) -> Array:
        """Selection proportional to fitness, f = t_max + t_min - t; INVALID has probability zero."""
        valid = np.isfinite(self._costs)
        if not valid.any():
            return np.full(self._size, 1 / self._size)
        times = np.where(valid, self._costs, 0.0)
        best, worst = times[valid].min(), times[valid].max()
        # A cost below zero (a benchmark function's) would make a fitness negative: the shift keeps the order.
        fitness = np.where(valid, worst + best - times - min(0.0, best), 0.0)
        total = fitness.sum()
        probabilities: Array = fitness / total if total > 0 else valid / valid.sum()
        return probabilities

    def _cross(self, mothers: Array, fathers: Array) -> Array:
        """Two-point crossover of 65 % of the couples: the genes between two cuts come from the father."""
        count, genes = mothers.shape
        cuts = np.sort(self._rng.integers(0, genes + 1, size=(count, 2)), axis=1)
        position = np.arange(genes)
        between = (position >= cuts[:, :1]) & (position < cuts[:, 1:])
        couples = self._rng.random((count, 1)) < CROSSOVER
        return np.where(between & couples, fathers, mothers)

    def _mutate(self, children: Array) -> Array:
        """Move one gene of every child, in place."""
        count, genes = children.shape
        row, gene = np.arange(count), self._rng.integers(0, genes, size=count)
        scale = self._objective.ranges.width[gene] * random_scales(MUTATION_DECADES, self._rng, count)
        children[row, gene] += scale * self._rng.standard_normal(count)
        return self._objective.ranges.confine(children)
