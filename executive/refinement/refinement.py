"""Subgoal refinement: values of the free parameters that minimise the predicted cost of the next actions (paper 6).

Anytime and resumable: the first check yields a greedy answer, every further check may yield a better one. The greedy
choice is searched before any other, because others have to be better than it by more than the models may err.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.certificate import Certificate, certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.deviation import required_gain_s
from tailor.executive.refinement.greedy import GreedySearch, greedy
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
      start: Values by variable id of an earlier answer: taken at once where they are better than the first greedy
        answer by enough, and an initial candidate.
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
        self._start = start or {}
        terms = (sequence.within(settings.horizon), sequence.variables, models, settings)
        self._objective = SequenceObjective(*terms)
        self._reporting = SequenceObjective(*terms)  # its evaluations do not count as the search's
        self._greedy: GreedySearch | None = None  # the first answer
        self._greedy_search: GreedySearch | None = None
        self._greedy_choice: Choice | None = None
        self._required_s = settings.gain_min_s  # predicted gain from which another choice is taken
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
        if self._solver is None:
            return self._greedy is not None and not self._objective.ids
        return self._solver.finished

    def advance(self, budget: Budget) -> None:
        """Resume the search until the budget is spent or the search is finished."""
        if self._greedy is None:
            if budget.spent():
                return
            self._begin()
        if self._solver is None and self._greedy_search is not None:
            self._greedy_search.advance(budget)
            if self._greedy_search.finished:
                self._compare(self._greedy_search.values)
        if self._solver is not None:
            before = self._solver.value
            self._solver.advance(budget)
            if self._solver.best is not None and self._solver.value < before:
                self._adopt(choice_of(self._reporting, self._solver.best))

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
            checks=(self._greedy is not None)
            + (self._greedy_search.checks if self._greedy_search else 0)
            + (self._solver.checks if self._solver else 0),
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
        return sum(search.evaluations for search in (self._greedy, self._greedy_search) if search is not None)

    @property
    def _greedy_s(self) -> float:
        return np.inf if self._greedy_choice is None else self._greedy_choice.total_s

    def _trace(self) -> tuple[tuple[int, float], ...]:
        """Improvements so far: the greedy answer, and all that are better."""
        trace = [(self._greedy_evaluations, self._greedy_s)] if np.isfinite(self._greedy_s) else []
        if self._solver is not None:
            first = self._greedy_evaluations
            trace += [(first + count, value) for count, value in self._solver.trace if value < self._greedy_s]
        return tuple(trace)

    @property
    def gap_pct(self) -> float | None:
        """Proven optimality gap in percent; None without a proof or above MAX_GAP_PCT."""
        gap = self._certificate.gap_pct if isinstance(self._certificate, Certificate) else None
        return gap if gap is not None and gap <= MAX_GAP_PCT else None

    def _begin(self) -> None:
        """The first check: a greedy answer, and the search that starts from it."""
        self._greedy = greedy(self._sequence, self._models, self._settings, self._rng)
        values = self._greedy.values
        self._choice = self._greedy_choice = choice_of(self._reporting, self._objective.vector(values))
        if not self._objective.ids:
            return
        if self._start:
            self._start = {**values, **self._start}
            self._required_s = required_gain_s(self._greedy_choice, self._settings)
            self._adopt(choice_of(self._reporting, self._objective.vector(self._start)))
        if self._settings.gain_k_std > 0 and len(self._sequence.units()[: self._settings.horizon]) > 1:
            terms = (self._sequence, self._models, self._settings, self._rng)
            self._greedy_search = GreedySearch(*terms, start=values)
        else:
            self._begin_solver(values)

    def _compare(self, values: Mapping[int, float]) -> None:
        """Take the greedy choice, unless the first answer is better than it by enough, and search for better ones."""
        first = self._choice
        self._choice = self._greedy_choice = choice_of(self._reporting, self._objective.vector(values))
        self._required_s = required_gain_s(self._greedy_choice, self._settings)
        assert first is not None
        self._adopt(first)
        self._begin_solver(values)

    def _begin_solver(self, values: Mapping[int, float]) -> None:
        starts = [values, self._start] if self._start else [values]
        seeds = self._objective.vectors([*starts, *self._sequence.starts])
        self._solver = solver_for(self._objective, self._settings, self._rng, seeds)

    def _adopt(self, choice: Choice) -> None:
        """Make a choice the answer, unless it is no better or its gain over greedy is too small."""
        assert self._choice is not None
        assert self._greedy_choice is not None
        if choice.total_s < min(self._choice.total_s, self._greedy_s - self._required_s):
            self._choice = choice
