"""Benchmark of plans chosen by the models in the kitchen: which of two cups first? Both ways take 12 steps.

The cups stand on two tables; each start draws to which other tables they go, and where the robot is.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from rich.console import Console

from tailor.executive import domains, planning
from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.schemas.kitchen.furniture import kitchen, on_table
from tailor.simnodes.world import World
from tailor.tools.benchmarks.planners.tours import Costs, compared
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep

DOMAIN, SCENARIO = "kitchen", "two-cups"
PROBLEM = """(define (problem two-errands) (:domain kitchen) (:objects dock from1 to1 from2 to2 - place cup1 cup3 - cup)
  (:init (robot-at dock) (cup-at cup1 from1) (cup-at cup3 from2) (hand-empty) (arm-home) (free to1) (free to2))
  (:goal (and (cup-at cup1 to1) (cup-at cup3 to2))))"""
CUPS = ("cup1", "cup3")  # on different tables
STREAM = 4  # of the draw of tables
LIMIT_S = 240.0
RUNS, QUICK_RUNS = 9, 1

Spots = dict[str, tuple[str, int]]


def errands(seed: int) -> Spots:
    """Table and slot of each place: where the map has the cups, and slots of other tables."""
    rng = np.random.default_rng([seed, STREAM])
    spots = {f"from{n}": kitchen().cups[cup][:2] for n, cup in enumerate(CUPS, 1)}
    for n in (1, 2):
        others = [table for table in kitchen().tables if table != spots[f"from{n}"][0]]
        spots[f"to{n}"] = str(rng.choice(others)), n - 1
    return spots


def driven(seed: int, costs: Costs) -> Run:
    """Both errands, in an order of the planner's choice."""
    context = build_context(ExecutiveConfig(DOMAIN, SCENARIO, Settings(seed=seed, plan_costs=costs)), SENDER)
    spots, (_, start) = errands(seed), domains.seeded_scenario(DOMAIN, SCENARIO, seed)
    settings = {**context.scenario.settings, "spots": spots, "cups": CUPS}
    scenario = replace(context.scenario, problem=PROBLEM, places={}, settings=settings)
    problem = planning.parse_problem(PROBLEM, context.pddl_domain, "errands")
    start = {name: value for name, value in start.items() if not name.startswith("cup")} | _cups(start, spots)
    world = World(new_body(context.domain), start, seed)
    return run_lockstep(replace(context, scenario=scenario, problem=problem), world, limit_s=LIMIT_S)


def _cups(start: dict[str, float], spots: Spots) -> dict[str, float]:
    """Values of the start for the cups' places, by the tables of that start; handles point away from the robot."""
    values: dict[str, float] = {}
    for n, cup in enumerate(CUPS, 1):
        table, slot = spots[f"from{n}"]
        frame = start[f"{table}_x"], start[f"{table}_y"], start[f"{table}_phi"]
        place = on_table(frame, *kitchen().table.slots[slot], math.pi)
        values |= {f"{cup}_{axis}": value for axis, value in zip(("x", "y", "phi"), place, strict=True)}
    return values


def run(console: Console, quick: bool) -> None:
    """Print one row for each way to choose."""
    console.print(compared("two errands in the kitchen", driven, QUICK_RUNS if quick else RUNS))
