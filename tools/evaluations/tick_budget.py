"""Deliberation that an evaluation's ticks may do: checks enough for nearly every search, or some CPU time, as live."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial

from tailor.executive.interfaces.budget import Budget
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import finite
from tailor.tools.lockstep.run import CHECKS_PER_TICK, DELIBERATION, cpu_budget

MAX_MS = 10_000.0


def configure_tick_budget(parser: argparse.ArgumentParser) -> None:
    """Declare `--tick-ms`."""
    parser.add_argument("--tick-ms", type=_milliseconds, default=0.0, metavar="MS",
                        help="CPU time for the deliberation of each tick: 60 as live, 15 as on a computer a quarter as "
                        f"fast; then runs do not repeat exactly (default: {CHECKS_PER_TICK} checks)")  # fmt: skip


def tick_budget(tick_ms: float) -> Callable[[], Budget]:
    """Makes the budget of each tick: `tick_ms` of this thread's CPU time; of 0 CHECKS_PER_TICK checks."""
    if not tick_ms:
        return DELIBERATION
    return partial(cpu_budget, round(1e6 * tick_ms))


def budget_remark(tick_ms: float) -> list[str]:
    """A line for the report of runs that depend on the computer's speed."""
    return [f"deliberation: {tick_ms:g} ms of this computer's CPU time in each tick"] if tick_ms else []


def _milliseconds(text: str) -> float:
    value = finite("--tick-ms")(text)
    if not 0 < value <= MAX_MS:
        raise UsageError(f"--tick-ms is {value:g}, expected more than 0, at most {MAX_MS:g}")
    return value
