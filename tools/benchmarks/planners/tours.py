"""Benchmark of plans chosen by the models: four places in any order, by steps and by predicted durations, paired."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.executive import planning
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.values import Array
from tailor.tools.benchmarks.intervals import half_width
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep
from tailor.tools.lockstep.worlds import make_world

DOMAIN, SCENARIO = "soccer", "waypoints"
PLACES = ("way1", "way2", "way3", "way4")
ROUTES = " ".join(f"(route {a} {b})" for a in ("home", *PLACES) for b in PLACES if a != b)
PROBLEM = f"""(define (problem tour) (:domain soccer) (:objects home {" ".join(PLACES)}) (:init (robot home) {ROUTES})
  (:goal (and {" ".join(f"(visited {place})" for place in PLACES)})))"""
RUNS, QUICK_RUNS = 17, 2
SAME_S = 0.05  # half a tick: runs that differ by less take as long
Costs = Literal["steps", "models"]


def driven(seed: int, costs: Costs) -> Run:
    """One tour through the places of the scenario, in an order of the planner's choice."""
    context = build_context(ExecutiveConfig(DOMAIN, SCENARIO, Settings(seed=seed, plan_costs=costs)), SENDER)
    problem = planning.parse_problem(PROBLEM, context.pddl_domain, "tour")
    context = replace(context, scenario=replace(context.scenario, problem=PROBLEM), problem=problem)
    return run_lockstep(context, make_world(context.domain.robot, SCENARIO, seed))


def run(console: Console, quick: bool) -> None:
    """Print one row for each way to choose."""
    console.print(compared("tours of four places", driven, QUICK_RUNS if quick else RUNS))


def compared(title: str, driven: Callable[[int, Costs], Run], count: int, first: int = 0) -> Table:
    """Runs with plans by steps and by models from so many starts; times are means over pairs that both achieve.

    Raises:
      NoMeasurement: There is no such pair.
    """
    seeds = range(first, first + count)
    runs = {costs: [driven(seed, costs) for seed in seeds] for costs in get_args(Costs)}
    table = Table(title=f"{title}, {count} start{'s'[: count != 1]}", box=None)
    for column in ("plans by", "achieved", "first action after", "mean duration", "saved", "faster", "slower"):
        table.add_column(column, justify="left" if column == "plans by" else "right")
    both = [n for n in range(count) if all(rows[n].achieved for rows in runs.values())]
    if not both:
        raise NoMeasurement(f"{title}: no start from which both kinds of plans achieve the goal")
    for costs, rows in runs.items():
        saved_s = np.array([runs["steps"][n].duration_s - rows[n].duration_s for n in both])
        times = (np.mean([rows[n].started_s for n in both]), np.mean([rows[n].duration_s for n in both]))
        counts = (int((saved_s > SAME_S).sum()), int((saved_s < -SAME_S).sum()))
        achieved = sum(row.achieved for row in rows)
        table.add_row(costs, str(achieved), *(f"{s:.2f} s" for s in times), _with_interval(saved_s), *map(str, counts))
    return table


def _with_interval(saved_s: Array) -> str:
    """Mean and its 95 % t-interval; of a single run no interval."""
    if len(saved_s) < 2:
        return f"{saved_s.mean():.2f} s"
    mean, half = saved_s.mean(), half_width(saved_s)
    return f"{mean:.2f} s ({mean - half:.2f} to {mean + half:.2f})"
