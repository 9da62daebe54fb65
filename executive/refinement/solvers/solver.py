"""Interface of all solvers, and of the objectives that they minimise.

A solver is anytime and resumable: each check of the budget is one batch of candidates, and the next `advance` resumes
where the last one stopped. It draws only from the given generator.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import Ranges


class Objective(Protocol):
    """Cost to be minimised over a box; +inf is INVALID."""

    ranges: Ranges

    @property
    def evaluations(self) -> int:
        """Number of model inputs predicted so far."""
        ...

    def __call__(self, candidates: Array) -> Array:
        """Cost of every candidate, shape (n, d) -> (n,)."""
        ...


@dataclass(frozen=True, slots=True)
class Limits:
    """End of a search: `patience` checks in which the value fell by at most `min_gain`, or `max_checks`."""

    patience: int
    max_checks: int
    min_gain: float = 0.0


class Solver:
    """Base of all solvers: best candidate, trace and end of the search; a subclass defines one check.

    Args:
      objective: Cost to minimise.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d); s may be 0.
      limits: End of the search.
    """

    def __init__(self, objective: Objective, rng: np.random.Generator, seeds: Array, limits: Limits) -> None:
        self.best: Array | None = None  # shape (d,); None until the first valid candidate
        self.value = np.inf
        self.trace: list[tuple[int, float]] = []  # improvements: number of model inputs so far, and the value
        self.checks = 0
        self._objective = objective
        self._rng = rng
        self._seeds = objective.ranges.confine(seeds.reshape(len(seeds), objective.ranges.count))
        self._limits = limits
        self._idle = 0
        self._milestone = np.inf  # value at the last renewal of patience

    @property
    def finished(self) -> bool:
        """Whether a larger budget would change nothing."""
        return self._idle >= self._limits.patience or self.checks >= self._limits.max_checks

    @property
    def elite(self) -> Array:
        """The best candidates known, shape (n, d), best first; none before the first valid one."""
        return np.empty((0, self._objective.ranges.count)) if self.best is None else self.best[None]

    def advance(self, budget: Budget) -> None:
        """Resume the search until the budget is spent or the search is finished."""
        while not self.finished and not budget.spent():
            self.checks += 1
            self._idle += 1
            self._check()
            if self.value < self._milestone - self._limits.min_gain:
                self._milestone, self._idle = self.value, 0

    def _check(self) -> None:
        """Evaluate one batch of candidates."""
        raise NotImplementedError

    def _consider(self, candidate: Array, value: float) -> None:
        """Keep the candidate, shape (d,), if it is the best so far."""
        if value < self.value:
            self.best = candidate.copy()
            self.value = float(value)
            self.trace.append((self._objective.evaluations, self.value))

    def _consider_all(self, candidates: Array, values: Array) -> None:
        """Keep the best of the candidates, shape (n, d), if it is the best so far."""
        index = int(np.argmin(values))
        self._consider(candidates[index], float(values[index]))
