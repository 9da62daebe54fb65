"""Subgoal refinement: values of the free parameters that minimise the predicted cost of the next actions (paper 6).

Anytime and resumable: the first check yields the greedy answer, every further check may yield a better one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.greedy import Greedy, greedy
from tailor.executive.refinement.objective.choice import Choice, choice_of
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Solver

MAX_GAP_PCT = 25.0  # a larger gap is not reported


@dataclass(frozen=True, slots=True)
class Report:
    """Course and result of the search."""

    solver: str
    evaluations: int  # number of model inputs predicted
    checks: int
    greedy_s: float  # value of the objective for the greedy choice
    best_s: float
    trace: tuple[tuple[int, float], ...]  # (evaluations, best value) at each improvement
    gap_pct: float | None = None  # proven upper bound on the gap between `best_s` and the models' optimum


class Refinement:
    """Refinement of one sequence that was instantiated from the current belief.

    Args:
      sequence: Instantiated, with asserted subgoals.
      models: Loaded models.
      settings: Horizon, objective and solver.
      rng: The only source of randomness.
      start: Values by variable id of an earlier answer, as an initial candidate.
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
        terms = (sequence.within(settings.horizon), sequence.variables, models, settings)
        self._objective = SequenceObjective(*terms)
        self._reporting = SequenceObjective(*terms)  # its evaluations do not count as the search's
        self._greedy: Greedy | None = None
        self._greedy_s = np.inf
        self._solver: Solver | None = None
        self._choice: Choice | None = None
        self._certificate: Certificate | NoBound | None = None

    @property
    def choice(self) -> Choice | None:
        """The best answer so far; None before the first check."""
        return self._choice

    @property
    def finished(self) -> bool:
        """Whether a larger budget would change nothing."""
        return self._greedy is not None and (self._solver is None or self._solver.finished)

    def advance(self, budget: Budget) -> None:
        """Resume the search until the budget is spent or the search is finished."""
        if self._greedy is None:
            if budget.spent():
                return
            self._begin()
        if self._solver is not None:
            before = self._solver.value
            self._solver.advance(budget)
            if self._solver.best is not None and self._solver.value < before:
                self._adopt(self._solver.best)

    def certify(self, budget: Budget) -> None:
        """Prove the optimality gap of the best answer once the search is finished; it changes no answer."""
        choice, enabled = self._choice, self._settings.certify_checks > 0 and self._objective.ids
        if not (enabled and self.finished and choice is not None and choice.valid):
            return
        if self._certificate is None:
            self._certificate = certificate(self._reporting, self._reporting.vector(choice.values), self._settings)
        if isinstance(self._certificate, Certificate):
            self._certificate.advance(budget)

    def report(self) -> Report:
        """Course of the search so far."""
        return Report(
            solver=type(self._solver).__name__ if self._solver else "",
            evaluations=self.evaluations,
            checks=(self._greedy is not None) + (self._solver.checks if self._solver else 0),
            greedy_s=self._greedy_s,
            best_s=self._choice.total_s if self._choice else np.inf,
            trace=self._trace(),
            gap_pct=self.gap_pct,
        )

    @property
    def evaluations(self) -> int:
        """Number of model inputs predicted so far."""
        return self._greedy_evaluations + self._objective.evaluations

    @property
    def _greedy_evaluations(self) -> int:
        """Number of model inputs predicted for the greedy answer."""
        return self._greedy.evaluations if self._greedy else 0

    def _trace(self) -> tuple[tuple[int, float], ...]:
        """Improvements so far: the greedy answer, and all that are better."""
        trace = [(self._greedy_evaluations, self._greedy_s)] if np.isfinite(self._greedy_s) else []
        if self._solver is not None:
            improvements = zip(self._solver.trace.evaluations, self._solver.trace.values, strict=True)
            first = self._greedy_evaluations
            trace += [(first + count, value) for count, value in improvements if value < self._greedy_s]
        return tuple(trace)

    @property
    def gap_pct(self) -> float | None:
        """Proven optimality gap in percent; None without a proof or above MAX_GAP_PCT."""
        gap = self._certificate.gap_pct if isinstance(self._certificate, Certificate) else None
        return gap if gap is not None and gap <= MAX_GAP_PCT else None

    def _begin(self) -> None:
        """The first check: the greedy answer, and the solver that starts from it."""
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
        """Make a candidate the answer, unless it is no better or its gain over greedy is too small."""
        total = float(self._reporting(candidate[None])[0])
        if self._choice is not None and total >= min(self._choice.total_s, self._greedy_s - self._settings.gain_min_s):
            return
        self._choice = choice_of(self._reporting, candidate)
