"""Benchmark of plans chosen by the models: four places in any order, by steps and by predicted durations, paired."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.executive import domains, planning
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.core.context import Settings
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep
from tailor.tools.lockstep.worlds import make_world

DOMAIN, SCENARIO = "soccer", "waypoints"
PLACES = ("way1", "way2", "way3", "way4")
ROUTES = " ".join(f"(route {a} {b})" for a in ("home", *PLACES) for b in PLACES if a != b)
PROBLEM = f"""(define (problem tour) (:domain soccer) (:objects home {" ".join(PLACES)}) (:init (robot home) {ROUTES})
  (:goal (and {" ".join(f"(visited {place})" for place in PLACES)})))"""
RUNS, QUICK_RUNS = 17, 2


def driven(seed: int, costs: Literal["steps", "models"]) -> Run:
    """One tour through the places of the scenario, in an order of the planner's choice."""
    context = build_context(ExecutiveConfig(DOMAIN, SCENARIO, Settings(seed=seed, plan_costs=costs)), SENDER)
    _, start = domains.seeded_scenario(DOMAIN, SCENARIO, seed)
    problem = planning.parse_problem(PROBLEM, context.pddl_domain, "tour")
    context = replace(context, scenario=replace(context.scenario, problem=PROBLEM), problem=problem)
    return run_lockstep(context, make_world(context.domain.robot, SCENARIO, seed).body, start, seed)


def run(console: Console, quick: bool) -> None:
    """Print one row for each way to choose."""
    seeds = range(QUICK_RUNS if quick else RUNS)
    runs = {costs: [driven(seed, costs) for seed in seeds] for costs in ("steps", "models")}
    table = Table(title=f"tours of four places, {len(seeds)} starts", box=None)
    for column in ("plans by", "achieved", "first action after", "mean duration", "faster than by steps"):
        table.add_column(column, justify="left" if column == "plans by" else "right")
    for costs, rows in runs.items():
        faster = sum(row.duration_s < other.duration_s for row, other in zip(rows, runs["steps"], strict=True))
        times = (np.mean([row.started_s for row in rows]), np.mean([row.duration_s for row in rows]))
        table.add_row(costs, str(sum(row.achieved for row in rows)), *(f"{s:.2f} s" for s in times), str(faster))
    console.print(table)
