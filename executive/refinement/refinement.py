"""Subgoal refinement: values for the free parameters that minimise the predicted cost of the next actions (paper 6).

Anytime and resumable: the first check yields the greedy answer, every further check may yield a better one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from executive.budget import Budget
from executive.library import Array, Models
from executive.refinement.greedy import Greedy, greedy
from executive.refinement.objective import SequenceObjective
from executive.refinement.selection import solver_for
from executive.refinement.sequence import ActionSequence
from executive.refinement.settings import RefinementSettings
from executive.refinement.solver import Solver


@dataclass(frozen=True, slots=True)
class Choice:
    """Values for the free parameters within the horizon, and what the models predict for them.

    Tuples have one entry for each action within the horizon, detours included. `total_s` is the objective's value
    (mean + k std, penalties); +inf when the choice is not valid.
    """

    values: dict[int, float]  # by variable id
    predicted_s: tuple[float, ...]
    spread_s: tuple[float, ...]
    failure: tuple[float, ...]  # predicted probability of failure
    total_s: float
    valid: bool


@dataclass(frozen=True, slots=True)
class Report:
    """How the search went."""

    solver: str
    evaluations: int  # action-model rows predicted
    checks: int
    greedy_s: float  # the objective's value for the greedy choice
    best_s: float
    trace: tuple[tuple[int, float], ...]  # (evaluations, best value) at each improvement


class Refinement:
    """The refinement of one sequence from the belief of now.

    Args:
      sequence: Instantiated, with detours asserted.
      models: The loaded models.
      settings: Horizon, objective and solver.
      rng: The only source of randomness.
      start: Values by variable id of an earlier answer, to begin with.
    """

    def __init__(
        self,
        sequence: ActionSequence,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
        start: Mapping[int, float] | None = None,
    ) -> None:
        self._sequence = sequence
        self._models = models
        self._settings = settings
        self._rng = rng
        self._start = start
        stretch = (sequence.within(settings.horizon), sequence.variables, models, settings)
        self._objective = SequenceObjective(*stretch)
        self._judge = SequenceObjective(*stretch)  # its rows are not the search's
        self._greedy: Greedy | None = None
        self._greedy_s = np.inf
        self._solver: Solver | None = None
        self._choice: Choice | None = None

    @property
    def choice(self) -> Choice | None:
        """The best answer so far; None before the first check."""
        return self._choice

    @property
    def finished(self) -> bool:
        """Whether more budget would change nothing."""
        return self._greedy is not None and (self._solver is None or self._solver.finished)

    def advance(self, budget: Budget) -> None:
        """Search on until the budget is spent or the search is finished."""
        if self._greedy is None:
            if budget.spent():
                return
            self._begin()
        if self._solver is not None:
            before = self._solver.value
            self._solver.advance(budget)
            if self._solver.best is not None and self._solver.value < before:
                self._adopt(self._solver.best)

    def report(self) -> Report:
        """How the search went so far."""
        solver = self._solver
        first = self._greedy.rows if self._greedy else 0
        trace = [(first, self._greedy_s)] if np.isfinite(self._greedy_s) else []
        if solver is not None:
            found = zip(solver.trace.rows, solver.trace.values, strict=True)
            trace += [(first + rows, value) for rows, value in found if value < self._greedy_s]
        return Report(
            type(solver).__name__ if solver else "",
            first + self._objective.rows,
            (self._greedy is not None) + (solver.checks if solver else 0),
            self._greedy_s,
            self._choice.total_s if self._choice else np.inf,
            tuple(trace),
        )

    def _begin(self) -> None:
        """The first check: the greedy answer, and the solver that goes on from it."""
        self._greedy = greedy(self._sequence, self._models, self._settings, self._rng)
        seed = self._objective.vector(self._greedy.values)
        self._adopt(seed)
        assert self._choice is not None
        self._greedy_s = self._choice.total_s
        if self._objective.ids:
            starts = [self._greedy.values] if self._start is None else [self._greedy.values, self._start]
            seeds = self._objective.vectors([*starts, *self._sequence.starts])
            self._solver = solver_for(self._objective, self._settings, self._rng, seeds)

    def _adopt(self, candidate: Array) -> None:
        """Make a candidate the answer, unless the one so far is better or greedy is nearly as good."""
        total = float(self._judge(candidate[None])[0])
        if self._choice is not None and total >= min(self._choice.total_s, self._greedy_s - self._settings.gain_min_s):
            return
        predictions = self._judge.predict(candidate)
        self._choice = Choice(
            self._judge.values(candidate),
            tuple(float(said.duration_s[0]) for said in predictions),
            tuple(float(said.spread_s[0]) for said in predictions),
            tuple(float(said.failure[0]) for said in predictions),
            total,
            bool(np.isfinite(total)),
        )
