"""Convergence of the solvers: gap to the best known value over CPU time on one core; then the time of proofs.

Compares the chain solver, the paper's genetic algorithm and our differential evolution with scipy's and, if installed,
CMA-ES. All minimise the same objective: sequences of AGILO, and whole plans of other robots, with their learned models.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.table import Column, Table

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import SolverName
from tailor.models.runtime import load_robot
from tailor.tools.benchmarks.intervals import half_width
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.refinement import certificates
from tailor.tools.benchmarks.refinement.cases import Case, cases
from tailor.tools.benchmarks.refinement.decisions import first_decision
from tailor.tools.benchmarks.refinement.runners import Progress, ours, runners
from tailor.tools.learning.fresh_seeds import fresh_seed

TASKS, QUICK_TASKS = 20, 5  # of each case
MOMENTS_MS = (5, 20, 60, 80)
REFERENCES: tuple[SolverName, ...] = ("chain", "differential")
LONG_MS = 1500  # the search for the best known value
DECISIONS = (("kitchen", "one-cup"),)  # scenarios whose first decision is a case, with all parameters of the plan


def rows(quick: bool = False) -> list[dict[str, object]]:
    """One row for each case and solver: gap over fresh tasks in percent at each moment: mean, 95 % interval, worst."""
    table = []
    for name, tasks in _tasks(QUICK_TASKS if quick else TASKS):
        races = [_race(task, models, seed) for seed, (models, task) in enumerate(tasks)]
        table += [_row(name, solver, [race[solver] for race in races]) for solver in races[0]]
    return table


def _tasks(count: int) -> Iterator[tuple[str, list[tuple[Models, Case]]]]:
    """Fresh tasks of each case, with the models that they are predicted with."""
    models = Models(*load_robot("agilo"))
    for name, drawn in cases(models, count, fresh_seed("soccer").seed).items():
        yield name, [(models, case) for case in drawn]
    for domain, scenario in DECISIONS:
        first = fresh_seed(domain).seed
        yield f"{domain} {scenario}", [first_decision(domain, scenario, first + i) for i in range(count)]


def _race(task: Case, models: Models, seed: int) -> dict[str, list[float]]:
    """By solver, the gap to the best known value at each moment, in percent."""
    limit_ms = MOMENTS_MS[-1]
    progress = {name: run(task.objective(models), task.starts, seed, limit_ms) for name, run in runners()}
    references = [ours(name)(task.objective(models), task.starts, 100, LONG_MS) for name in REFERENCES]
    best = min(best_at(one, LONG_MS) for one in [*references, *progress.values()])
    if not np.isfinite(best):
        raise NoMeasurement(f"no solver has found a valid choice for {task.name}")
    return {name: [100 * (best_at(one, moment) / best - 1) for moment in MOMENTS_MS] for name, one in progress.items()}


def _row(case: str, solver: str, gaps: list[list[float]]) -> dict[str, object]:
    means = zip(MOMENTS_MS, np.mean(gaps, axis=0), strict=True)
    with np.errstate(invalid="ignore"):  # infinite where a task had no valid choice at that moment
        half = half_width(gaps)
    worst = zip(MOMENTS_MS, np.max(gaps, axis=0), strict=True)
    return {
        "case": case,
        "solver": solver,
        "n": len(gaps),
        **{f"gap_pct_at_{moment}_ms": round(float(gap), 3) for moment, gap in means},
        **{f"gap_half_ci95_at_{moment}_ms": round(float(h), 3) for moment, h in zip(MOMENTS_MS, half, strict=True)},
        **{f"worst_pct_at_{moment}_ms": round(float(gap), 3) for moment, gap in worst},
    }


def best_at(progress: Progress, moment_ms: float) -> float:
    """Best value up to a moment; inf if there is none."""
    return min((value for at, value in progress if at <= moment_ms), default=float("inf"))


def _percent(value: object) -> str:
    """A gap in percent; a dash if a task had no valid choice at that moment."""
    return f"{value:.2f}" if isinstance(value, float) and np.isfinite(value) else "—"


def run(console: Console, quick: bool) -> None:
    """Print the tables of the solvers and of the proofs.

    Raises:
      NoMeasurement: No solver has found a valid choice for a task.
    """
    table = Table(
        *(Column(name, no_wrap=True) for name in ("case", "solver")),
        title=f"refinement: mean gap in % to the best known value after CPU time, {QUICK_TASKS if quick else TASKS} "
        f"tasks a case, seed {fresh_seed('soccer').seed}",
        box=None,
    )
    for moment in MOMENTS_MS:
        table.add_column(f"{moment} ms", justify="right", no_wrap=True)
    table.add_column("± 95 % at 60 ms", justify="right")
    table.add_column("worst at 60 ms", justify="right")
    for row in rows(quick):
        columns = [
            *(f"gap_pct_at_{moment}_ms" for moment in MOMENTS_MS),
            "gap_half_ci95_at_60_ms",
            "worst_pct_at_60_ms",
        ]
        table.add_row(str(row["case"]), str(row["solver"]), *(_percent(row[column]) for column in columns))
    console.print(table)
    if importlib.util.find_spec("cma") is None:
        console.print("CMA-ES is omitted: package cma is not installed (extra `test`)")
    models = Models(*load_robot("agilo"))
    certificates.show(console, models, cases(models, 3 if quick else 9))
