"""Benchmark of planning with durations: two robots carry n cups, 4 n steps; first plan, and the makespan after 5 s.

Wall seconds, since kairos-planner runs in a process of its own, as in the executive; it has one thread. Completion by
causal links is included.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table

from tailor.executive.planning import Problem, Result, Settings
from tailor.tools.benchmarks.planning import read, texts
from tailor.tools.plan_search.limits import Limits
from tailor.tools.plan_search.sources import built_in, external, with_kairos

CUPS = (2, 3, 4, 8, 16)
SEARCH_LIMIT = 20_000  # generated plans of the built-in search
IMPROVE_S = 5


@dataclass(frozen=True, slots=True)
class Cell:
    """Time and result of one planner."""

    seconds: float
    result: Result

    def __str__(self) -> str:
        plan = self.result.plan
        return f"{plan.makespan:.2f} s, {self.seconds:.2f} s" if plan is not None else f"no plan, {self.seconds:.2f} s"


def durative_problem_text(cups: int) -> str:
    """PDDL of the problem: the cups stand on two tables by turns, and go to a third."""
    names = [f"cup{n}" for n in range(1, cups + 1)]
    initial = " ".join(f"(cup-at {name} table{1 if n % 2 == 0 else 3})" for n, name in enumerate(names))
    goal = " ".join(f"(cup-at {name} table2)" for name in names)
    return (
        f"(define (problem durative-cups-{cups}) (:domain kitchen-durative) (:objects r1 r2 - robot "
        f"dock table1 table2 table3 - place {' '.join(names)} - cup) (:init (robot-at r1 dock) (robot-at r2 dock) "
        f"(hand-empty r1) (hand-empty r2) {initial}) (:goal (and {goal})) (:metric minimize (total-time)))"
    )


def cells(cups: int) -> list[Cell]:
    """The built-in search, `auto`, Kairos' first plan, and its best plan after IMPROVE_S."""
    domain_text, _ = texts("kitchen-durative-s1")
    pair = (domain_text, durative_problem_text(cups))
    problem = read(*pair)
    return [
        _timed(lambda: built_in(problem.domain, problem, Settings(node_limit=SEARCH_LIMIT), Limits())),
        _timed(lambda: with_kairos(pair, problem.domain, problem, Settings(), Limits())[0]),
        _timed(lambda: _external("kairos", pair, problem)),
        _timed(lambda: _external(f"kairos:{IMPROVE_S}", pair, problem)),
    ]


def _external(command: str, pair: tuple[str, str], problem: Problem) -> Result:
    return external(command, pair, problem.domain, problem, 60.0)


def _timed(planned: Callable[[], Result]) -> Cell:
    started = time.monotonic()
    result = planned()
    return Cell(time.monotonic() - started, result)


def run(console: Console, quick: bool) -> None:
    """Print the table; a line instead if kairos-planner is not installed."""
    from tailor.runtime.planners.named import kairos_installed

    if not kairos_installed():
        console.print("planning with durations: not measured, kairos-planner is not installed")
        return
    table = Table(title="planning with durations: two robots, n cups; makespan, wall time to plan", box=None)
    for column in ("cups", "built-in search", "auto", "kairos, first", f"kairos, {IMPROVE_S} s"):
        table.add_column(column, justify="right")
    for cups in CUPS[:3] if quick else CUPS:
        table.add_row(str(cups), *map(str, cells(cups)))
    console.print(table)
