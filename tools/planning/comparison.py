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
from tailor.runtime.planners.named import check_engine
from tailor.tools.cli.plain_text import plain
from tailor.tools.plan_search.sources import external


@dataclass(frozen=True, slots=True)
class Row:
    """What one planner found.

    `makespan` in seconds, None without durations; `cost` is what the steps add to (total-cost), None without costs.
    Both times include the start of that planner's program; `reason` states why there is no sound plan.
    """

    planner: str
    steps: int | None
    makespan: float | None
    cost: float | None
    cpu_s: float
    wall_s: float
    valid: bool
    reason: str


@dataclass(frozen=True, slots=True)
class _Moment:
    """CPU time of this process and of its children that have ended, and time on a monotonic clock, both in seconds."""

    cpu_s: float
    wall_s: float

    def after(self, earlier: _Moment) -> _Moment:
        """What has passed since an earlier one."""
        return _Moment(self.cpu_s - earlier.cpu_s, self.wall_s - earlier.wall_s)


def compare(
    external_name: str,
    ours: Callable[[], Result],
    commands: Sequence[str],
    texts: tuple[str, str],
    problem: Problem,
    limit_s: float,
) -> list[Row]:
    """One row for the planner of the options, then one for each other.

    Args:
      external_name: That planner, if it is an external one; else empty.
      ours: Plans with it, within the limits of the options.
      commands: External planners as for `--planner`.
      texts: PDDL of domain and problem, for external planners.
      problem: The same, parsed.
      limit_s: Wall time of each external planner.

    Raises:
      UsageError: A command cannot be started, or names no engine.
    """
    before = _now()
    for command in (external_name, *commands):
        check_engine(command)
    spent_on_checks = _now().after(before)
    begun = _now() if external_name else _Moment(spent_on_checks.cpu_s, _started_s() + spent_on_checks.wall_s)
    row = _row(external_name or "tailor", ours, problem, begun)
    plans = (partial(external, name, texts, problem.domain, problem, limit_s) for name in commands)
    return [row, *(_row(name, plan, problem, _now()) for name, plan in zip(commands, plans, strict=True))]


def _row(name: str, plan: Callable[[], Result], problem: Problem, begun: _Moment) -> Row:
    """The figures of one planner."""
    result = plan()
    used = _now().after(begun)
    found, times = result.plan, (round(used.cpu_s, 3), round(used.wall_s, 3))
    fault = result.reason if found is None else validate(found, problem.domain, problem)
    if found is None:
        return Row(name, None, None, None, *times, False, fault)
    costly = any(action.cost is not None for action in problem.domain.actions)
    return Row(
        name,
        len(found.steps),
        found.makespan if found.durative else None,
        total_cost(found, problem) if costly and not fault else None,
        *times,
        not fault,
        fault,
    )


def _now() -> _Moment:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return _Moment(time.process_time() + used.ru_utime + used.ru_stime, time.monotonic())


def _started_s() -> float:
    """When this process started, on the monotonic clock; where Linux does not tell, later by what it waited."""
    try:
        started_ticks = int(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        age_s = time.clock_gettime(time.CLOCK_BOOTTIME) - started_ticks / os.sysconf("SC_CLK_TCK")
    except (OSError, AttributeError):
        age_s = time.process_time()
    return time.monotonic() - age_s


def table(rows: Sequence[Row], problem: str) -> Table:
    """The rows as a table."""
    drawn = Table(title=problem, title_justify="left", box=None)
    drawn.add_column("planner")
    for column in ("steps", "makespan", "cost", "CPU s", "time s"):
        drawn.add_column(column, justify="right", no_wrap=True)
    drawn.add_column("plan")
    for row in rows:
        numbers = ("-" if number is None else format_number(number) for number in (row.steps, row.makespan, row.cost))
        drawn.add_row(row.planner, *numbers, f"{row.cpu_s:.2f}", f"{row.wall_s:.2f}", plain(row.reason) or "sound")
    return drawn
