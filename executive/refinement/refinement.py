"""Subgoal refinement: values for the free parameters that minimise the predicted cost of the next actions (paper 6).

Anytime and resumable: the first check yields the greedy answer, every further check may yield a better one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.gate import Verdict, judge
from tailor.executive.refinement.greedy import Greedy, LocalSearch, greedy
from tailor.executive.refinement.objective.choice import Choice, choice_of
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Solver

__all__ = ["Choice", "Refinement", "Report"]

USEFUL_GAP_PCT = 25.0  # a bound that is farther off is no certificate


@dataclass(frozen=True, slots=True)
class Report:
    """How the search went."""

    solver: str
    evaluations: int  # action-model rows predicted
    checks: int
    greedy_s: float  # the objective's value for the greedy choice
    best_s: float
    trace: tuple[tuple[int, float], ...]  # (evaluations, best value) at each improvement
    verdict: Verdict = field(default_factory=Verdict)  # whether refining is worth it
    gap_pct: float | None = None  # proven: `best_s` is at most so much above the models' optimum


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
        self._alone: Choice | None = None  # the greedy choice
        self._verdict = Verdict()
        self._polish: LocalSearch | None = None
        self._certificate: Certificate | NoBound | None = None

    @property
    def choice(self) -> Choice | None:
        """The best answer so far, or the greedy one where refining is not worth it; None before the first check."""
        return self._alone if self._verdict.keep_greedy else self._choice

    @property
    def finished(self) -> bool:
        """Whether more budget would change nothing."""
        if self._greedy is None:
            return False
        found = self._solver is None or self._solver.finished
        return found and (not self._verdict.keep_greedy or (self._polish is not None and self._polish.finished))

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
            if self._solver.finished and self._verdict.keep_greedy:
                self._go_greedy(budget)

    def certify(self, budget: Budget) -> None:
        """Once the search is finished, prove how near its best answer is to the optimum; it changes no answer."""
        choice, wanted = self._choice, self._settings.certify_checks > 0 and self._objective.ids
        if not (wanted and self.finished and choice is not None and choice.valid):
            return
        if self._certificate is None:
            self._certificate = certificate(self._judge, self._judge.vector(choice.values), self._settings)
        if isinstance(self._certificate, Certificate):
            self._certificate.advance(budget)

    def report(self) -> Report:
        """How the search went so far."""
        searches = [search for search in (self._solver, self._polish) if search is not None]
        return Report(
            solver=type(self._solver).__name__ if self._solver else "",
            evaluations=self.evaluations,
            checks=(self._greedy is not None) + sum(search.checks for search in searches),
            greedy_s=self._greedy_s,
            best_s=self._choice.total_s if self._choice else np.inf,
            trace=self._trace(),
            verdict=self._verdict,
            gap_pct=self.gap_pct,
        )

    @property
    def evaluations(self) -> int:
        """Sequences that were judged so far."""
        return self._first + self._objective.rows + (self._polish.rows if self._polish else 0)

    @property
    def _first(self) -> int:
        """Rows that were predicted for the greedy answer."""
        return self._greedy.rows if self._greedy else 0

    def _trace(self) -> tuple[tuple[int, float], ...]:
        """The improvements so far: the greedy answer, and what beat it."""
        trace = [(self._first, self._greedy_s)] if np.isfinite(self._greedy_s) else []
        if self._solver is not None:
            found = zip(self._solver.trace.rows, self._solver.trace.values, strict=True)
            trace += [(self._first + rows, value) for rows, value in found if value < self._greedy_s]
        return tuple(trace)

    @property
    def gap_pct(self) -> float | None:
        """The gap that was proven, if it says anything."""
        gap = self._certificate.gap_pct if isinstance(self._certificate, Certificate) else None
        return gap if gap is not None and gap <= USEFUL_GAP_PCT else None

    def _begin(self) -> None:
        """The first check: the greedy answer, and the solver that goes on from it."""
        self._greedy = greedy(self._sequence, self._models, self._settings, self._rng)
        seed = self._objective.vector(self._greedy.values)
        self._adopt(seed)
        assert self._choice is not None
        self._alone = self._choice
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
        self._choice = choice_of(self._judge, candidate)
        if self._alone is not None:
            self._verdict = judge(self._sequence, self._alone, self._choice, self._models.gate)

    def _go_greedy(self, budget: Budget) -> None:
        """Refining is not worth it: search the greedy choice out, as a horizon of one does."""
        assert self._greedy is not None
        if self._polish is None:
            self._polish = LocalSearch(self._sequence, self._greedy, self._models, self._settings, self._rng)
        self._polish.advance(budget)
        polished = choice_of(self._judge, self._judge.vector(self._polish.values))
        if polished.valid:
            self._alone = polished
