"""Compares our plan with those of other planners: steps, makespan, cost, time and validity, side by side."""

from __future__ import annotations

import os
import resource
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from rich.table import Table

from tailor.executive.planning import Problem, Result, validate
from tailor.executive.planning.pddl.formula_text import format_number
from tailor.executive.planning.plan_quality import total_cost
from tailor.tools.plan_search.sources import external


@dataclass(frozen=True, slots=True)
class Row:
    """What one planner found.

    `makespan` in seconds, None without durations; `cost` is what the steps add to (total-cost), None without costs.
    Both times include the start of a program; `reason` states why there is no sound plan.
    """

    planner: str
    steps: int | None
    makespan: float | None
    cost: float | None
    cpu_s: float
    wall_s: float
    valid: bool
    reason: str


def compare(
    name: str,
    ours: Callable[[], Result],
    commands: Sequence[str],
    texts: tuple[str, str],
    problem: Problem,
    limit_s: float,
) -> list[Row]:
    """One row for the planner of the options, then one for each other.

    Args:
      name: That planner.
      ours: Plans with it, within the limits of the options.
      commands: External planners as for `--planner`.
      texts: PDDL of domain and problem, for external planners.
      problem: The same, parsed.
      limit_s: Wall time of each external planner.

    Raises:
      UsageError: A command cannot be started.
    """
    row = _row(name, ours, problem, since_start=True)
    plans = (partial(external, name, texts, problem.domain, problem, limit_s) for name in commands)
    return [row, *(_row(name, plan, problem) for name, plan in zip(commands, plans, strict=True))]


def _row(name: str, plan: Callable[[], Result], problem: Problem, since_start: bool = False) -> Row:
    """The figures of one planner; `since_start` counts what this process did before, its start and reading."""
    before_s = 0.0 if since_start else _cpu_s()
    began = time.monotonic() - (_age_s() if since_start else 0.0)
    result = plan()
    wall_s, cpu_s = time.monotonic() - began, _cpu_s() - before_s
    found = result.plan
    fault = result.reason if found is None else validate(found, problem.domain, problem)
    if found is None:
        return Row(name, None, None, None, round(cpu_s, 3), round(wall_s, 3), False, fault)
    costly = any(action.cost is not None for action in problem.domain.actions)
    return Row(
        name,
        len(found.steps),
        found.makespan if found.durative else None,
        total_cost(found, problem) if costly and not fault else None,
        round(cpu_s, 3),
        round(wall_s, 3),
        not fault,
        fault,
    )


def _age_s() -> float:
    """Wall time since this process started; where Linux does not tell, its CPU time, which is a little less."""
    try:
        started_ticks = int(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        return time.clock_gettime(time.CLOCK_BOOTTIME) - started_ticks / os.sysconf("SC_CLK_TCK")
    except (OSError, AttributeError):
        return time.process_time()


def _cpu_s() -> float:
    """CPU time of this process and of its children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + used.ru_utime + used.ru_stime


def table(rows: Sequence[Row], problem: str) -> Table:
    """The rows as a table."""
    drawn = Table(title=problem, title_justify="left", box=None)
    drawn.add_column("planner")
    for column in ("steps", "makespan", "cost", "CPU s", "time s"):
        drawn.add_column(column, justify="right", no_wrap=True)
    drawn.add_column("plan")
    for row in rows:
        numbers = ("-" if number is None else format_number(number) for number in (row.steps, row.makespan, row.cost))
        drawn.add_row(row.planner, *numbers, f"{row.cpu_s:.2f}", f"{row.wall_s:.2f}", row.reason or "sound")
    return drawn
