"""What a solver is, and what it minimises: the one interface behind which all optimisers stand.

A solver is anytime and resumable: each check of the budget is one batch of candidates, and the next `advance` goes on
where the last one stopped. It draws only from the generator handed in.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import Ranges


class Objective(Protocol):
    """A cost to be minimised over a box; +inf is INVALID."""

    ranges: Ranges

    @property
    def rows(self) -> int:
        """Action-model rows predicted so far."""
        ...

    def __call__(self, candidates: Array) -> Array:
        """The cost of every candidate, shape (n, d) -> (n,)."""
        ...


@dataclass(frozen=True, slots=True)
class Limits:
    """When a search is finished: `patience` checks in which the value fell by no more than `worth`, or `checks_max`."""

    patience: int
    checks_max: int
    worth: float = 0.0


@dataclass(slots=True)
class Trace:
    """How the best value fell: at which check and after how many model rows."""

    checks: list[int] = field(default_factory=list)
    rows: list[int] = field(default_factory=list)
    values: list[float] = field(default_factory=list)

    def note(self, checks: int, rows: int, value: float) -> None:
        """Add an improvement."""
        self.checks.append(checks)
        self.rows.append(rows)
        self.values.append(value)


class Solver:
    """Keeps the best candidate, the trace, and when to stop; subclasses say what one check does.

    Args:
      objective: What is minimised.
      rng: The only source of randomness.
      seeds: Candidates to begin with, shape (s, d); s may be 0.
      limits: When the search is finished.
    """

    def __init__(self, objective: Objective, rng: np.random.Generator, seeds: Array, limits: Limits) -> None:
        self.best: Array | None = None  # shape (d,), None until a valid candidate has been seen
        self.value = np.inf
        self.trace = Trace()
        self.checks = 0
        self._objective = objective
        self._rng = rng
        self._seeds = objective.ranges.confine(seeds.reshape(len(seeds), objective.ranges.count))
        self._limits = limits
        self._idle = 0
        self._milestone = np.inf  # the value when patience was last renewed

    @property
    def finished(self) -> bool:
        """Whether more budget would change nothing."""
        return self._idle >= self._limits.patience or self.checks >= self._limits.checks_max

    def advance(self, budget: Budget) -> None:
        """Search on until the budget is spent or the search is finished."""
        while not self.finished and not budget.spent():
            self.checks += 1
            self._idle += 1
            self._check()
            if self.value < self._milestone - self._limits.worth:
                self._milestone, self._idle = self.value, 0

    def _check(self) -> None:
        """One batch of candidates."""
        raise NotImplementedError

    def _consider(self, candidate: Array, value: float) -> None:
        """Keep the candidate, shape (d,), if it is the best so far."""
        if value < self.value:
            self.best = candidate.copy()
            self.value = float(value)
            self.trace.note(self.checks, self._objective.rows, self.value)

    def _consider_all(self, candidates: Array, values: Array) -> None:
        """Keep the best of the candidates, shape (n, d), if it is the best so far."""
        index = int(np.argmin(values))
        self._consider(candidates[index], float(values[index]))
