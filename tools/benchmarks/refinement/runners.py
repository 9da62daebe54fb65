"""Optimisers of the refinement benchmark behind one call: (objective, starts, seed, limit) -> best value over time."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings, SolverName
from tailor.executive.refinement.solvers.selection import solver_for

OURS: tuple[SolverName, ...] = ("chain", "genetic", "differential")

Progress = list[tuple[float, float]]  # (CPU milliseconds of this process, best value so far), in order of time
Starts = Sequence[Mapping[int, float]]  # initial candidates; external optimisers begin with the first
Runner = Callable[[SequenceObjective, Starts, int, float], Progress]


def runners() -> Iterator[tuple[str, Runner]]:
    """Every optimiser by name; CMA-ES if it is installed."""
    for name in OURS:
        yield name, ours(name)
    yield "scipy DE", _scipy
    try:
        import cma  # noqa: F401
    except ImportError:
        return
    yield "CMA-ES", _cma


def ours(name: SolverName) -> Runner:
    """One of the executive's own solvers."""

    def run(objective: SequenceObjective, starts: Starts, seed: int, limit_ms: float) -> Progress:
        settings = RefinementSettings(solver=name, patience=10**6, checks_max=10**6)
        rng = np.random.default_rng(seed)
        began, progress = time.process_time(), []
        solver = solver_for(objective, settings, rng, objective.vectors(starts))
        while (elapsed := 1e3 * (time.process_time() - began)) < limit_ms and not solver.finished:
            solver.advance(CheckBudget(1))
            progress.append((1e3 * (time.process_time() - began), solver.value))
        return progress or [(elapsed, float("inf"))]

    return run


class _OverError(Exception):
    """The time limit is reached."""


class _Timed:
    """Objective for external optimisers; records the time of each best value and ends the search at the limit."""

    def __init__(self, objective: SequenceObjective, limit_ms: float) -> None:
        self.progress: Progress = []
        self._objective = objective
        self._limit_ms = limit_ms
        self._began = time.process_time()

    def __call__(self, candidates: Array) -> Array:
        """Cost, shape (n,), of candidates, shape (n, d); INVALID as a finite number, which external code can sort."""
        costs = self._objective(self._objective.ranges.confine(candidates))
        now = 1e3 * (time.process_time() - self._began)
        self.progress.append((now, min(float(costs.min()), self.progress[-1][1] if self.progress else float("inf"))))
        if now > self._limit_ms:
            raise _OverError
        return np.where(np.isfinite(costs), costs, 1e6)


def _scipy(objective: SequenceObjective, starts: Starts, seed: int, limit_ms: float) -> Progress:
    """Differential evolution with scipy's recommended settings, which evaluates a generation at once."""
    from scipy.optimize import differential_evolution

    timed = _Timed(objective, limit_ms)
    bounds = list(zip(objective.ranges.lower, objective.ranges.upper, strict=True))
    options = {"strategy": "best1bin", "init": "latinhypercube", "popsize": 15, "polish": False, "maxiter": 10**6}
    first = objective.vectors(starts)[0] if starts else None
    with contextlib.suppress(_OverError):
        while True:  # a population that has converged is drawn anew
            differential_evolution(
                lambda x: timed(x.T), bounds, rng=seed, x0=first, vectorized=True, updating="deferred", **options
            )
            seed, first = seed + 1000, None
    return timed.progress


def _cma(objective: SequenceObjective, starts: Starts, seed: int, limit_ms: float) -> Progress:
    """BIPOP-CMA-ES with its authors' settings: 0.3 of the range, restarts from random places, periodic angles free."""
    import cma

    timed, ranges, rng = _Timed(objective, limit_ms), objective.ranges, np.random.default_rng(seed)
    first = [(vector - ranges.lower) / ranges.width for vector in objective.vectors(starts)[:1]] if starts else []
    limits = [[None if wraps else end for wraps in ranges.periodic.tolist()] for end in (0.0, 1.0)]
    options = {"bounds": limits, "seed": seed + 1, "verbose": -9, "verb_log": 0, "verb_disp": 0}

    def costs(samples: Sequence[Array]) -> list[float]:
        return list(timed(ranges.lower + ranges.width * np.array(samples)))

    def place() -> Array:
        return first.pop() if first else rng.random(ranges.count)

    with contextlib.suppress(_OverError):
        while True:
            cma.fmin2(None, place, 0.3, options, bipop=True, restarts=9, parallel_objective=costs)
    return timed.progress
