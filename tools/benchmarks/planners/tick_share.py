"""Benchmark of planning inside ticks: its share of a tick's time in every scenario, in lock-step.

CPU time of the search, the reuse of the last plan and the search for a better one, relative to the tick of 100 ms.
Deliberation has its live budget, in CPU time; garbage is collected between the ticks, as in the live loop. The
scenarios' disturbances happen.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.deliberation.plan_reuse import Preparation
from tailor.executive.deliberation.plan_source import PlanSource
from tailor.executive.replay import RecordedTick
from tailor.executive.shell import DELIBERATION_NS
from tailor.runtime.gc_freeze import gc_disabled
from tailor.runtime.realtime import collect_garbage
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names
from tailor.tools.lockstep.run import SENDER, cpu_budget, run_lockstep
from tailor.tools.lockstep.worlds import make_world

SECONDS, QUICK_SECONDS = 60.0, 8.0


def shares(domain: str, scenario: str, seconds: float) -> list[float]:
    """Share of planning in each tick of one run, in percent of the tick."""
    gc.collect()
    with gc_disabled():
        return _shares(domain, scenario, seconds)


def _shares(domain: str, scenario: str, seconds: float) -> list[float]:
    world = make_world(domains.load(domain).robot, scenario, 0)
    context = build_context(ExecutiveConfig(domain, scenario), SENDER)
    marks = [0]

    def on_tick(tick: RecordedTick, outputs: tuple[Output, ...]) -> None:
        marks.append(searched[0] + shortened[0] + improved[0])
        collect_garbage(tick.tick)

    suffix, better = _timed(Preparation, "advance_suffix"), _timed(Preparation, "advance")
    with _timed(PlanSource, "advance") as searched, suffix as shortened, better as improved:
        run_lockstep(
            context, world, limit_s=seconds, on_tick=on_tick,
            new_budget=partial(cpu_budget, DELIBERATION_NS),
        )  # fmt: skip
    return [100.0 * float(ns) / PERIOD_NS for ns in np.diff(marks)]


@contextmanager
def _timed(kind: type[Any], name: str) -> Iterator[list[int]]:
    """The CPU nanoseconds spent in a method while the context lasts, in a list of one number."""
    real, spent = getattr(kind, name), [0]

    def timed(self: Any, *arguments: Any) -> Any:
        started_ns = time.process_time_ns()
        try:
            return real(self, *arguments)
        finally:
            spent[0] += time.process_time_ns() - started_ns

    setattr(kind, name, timed)
    try:
        yield spent
    finally:
        setattr(kind, name, real)


def run(console: Console, quick: bool) -> None:
    """Print one row for each scenario."""
    table = Table(title="planning in percent of a tick (100 ms), CPU time", box=None)
    table.add_column("scenario", no_wrap=True)
    for column in ("ticks", "p50", "p99", "max"):
        table.add_column(column, justify="right")
    for domain in domain_names():
        for scenario in domains.scenarios(domain)[: 2 if quick else None]:
            try:
                shared = shares(domain, scenario, QUICK_SECONDS if quick else SECONDS)
            except (UsageError, ModuleNotFoundError) as reason:  # no simulated body, its engine or its models
                console.print(f"{domain} {scenario}: not measured: {reason}")
                continue
            p50, p99, most = np.percentile(shared, [50, 99, 100])
            table.add_row(f"{domain} {scenario}", str(len(shared)), *(f"{p:.2f}" for p in (p50, p99, most)))
    console.print(table)
