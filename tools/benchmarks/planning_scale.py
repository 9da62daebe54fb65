"""Benchmark of planning as the work grows: n cups from one table to another, 4 n steps.

CPU seconds from the parsed problem to the first plan, grounding included, of each engine and of kairos-planner if it is
installed. Partial-order search alone stops at `POCL_LIMIT` generated plans.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any

from rich.console import Console
from rich.table import Table

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import EngineName, Problem, Search, Settings
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.planning import UNLIMITED, names, read, texts

CUPS = (2, 3, 4, 5, 10, 20, 40)
POCL_LIMIT = 20_000
ENGINES: tuple[EngineName, ...] = ("pocl", "forward", "auto")


def problem_text(cups: int) -> str:
    """PDDL of the problem; its domain is that of the kitchen problems."""
    objects = f"dock table1 table2 - place {' '.join(f'cup{n}' for n in range(cups))} - cup"
    return (
        f"(define (problem cups-{cups}) (:domain kitchen) (:objects {objects}) "
        f"(:init (robot-at dock) (hand-empty) {_cups_at('table1', cups)}) (:goal {goal_text(cups)}))"
    )


def goal_text(cups: int) -> str:
    """PDDL of its goal."""
    return f"(and {_cups_at('table2', cups)})"


def _cups_at(table: str, cups: int) -> str:
    return " ".join(f"(cup-at cup{n} {table})" for n in range(cups))


def rows(quick: bool) -> list[dict[str, Any]]:
    """One row for each number of cups: steps and CPU seconds by planner, None without a plan."""
    if not names():
        raise NoMeasurement("no problems, expected a checkout of the repository")
    domain_text, _ = texts("kitchen-s1")
    return [_row(cups, domain_text) for cups in (CUPS[:-1] if quick else CUPS)]


def _row(cups: int, domain_text: str) -> dict[str, Any]:
    text = problem_text(cups)
    problem = read(domain_text, text)
    row: dict[str, Any] = {"cups": cups}
    for engine in ENGINES:
        row[engine] = _measured(partial(_steps, problem, engine))
    row["kairos"] = _measured(partial(_steps_of_kairos, domain_text, text))
    return row


def _measured(steps_of: Callable[[], int | None]) -> tuple[int, float] | None:
    """Steps and CPU seconds; None without a plan."""
    started = time.process_time()
    steps = steps_of()
    return None if steps is None else (steps, time.process_time() - started)


def _steps(problem: Problem, engine: EngineName) -> int | None:
    settings = Settings(engine=engine, node_limit=POCL_LIMIT if engine == "pocl" else Settings().node_limit)
    result = Search(problem.domain, problem, settings).advance(CheckBudget(UNLIMITED))
    return len(result.plan.steps) if result is not None and result.plan is not None else None


def _steps_of_kairos(domain_text: str, text: str) -> int | None:
    try:
        import kairos
    except ImportError:
        return None
    result = kairos.solve(domain_text, text, anytime=False, threads=1)
    return len(result.plan.steps) if result.plan is not None else None


def run(console: Console, quick: bool) -> None:
    """Print the table."""
    table = Table(title="planning: n cups from table to table; steps, CPU s to the first plan", box=None)
    for column in ("cups", *ENGINES, "kairos"):
        table.add_column(column, justify="right")
    for row in rows(quick):
        cells = [row[name] for name in (*ENGINES, "kairos")]
        shown = ["no plan" if cell is None else f"{cell[0]} steps, {cell[1]:.3f} s" for cell in cells]
        table.add_row(str(row["cups"]), *shown)
    console.print(table)
