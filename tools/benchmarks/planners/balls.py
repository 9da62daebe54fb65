"""Benchmark of plans chosen by the models: which of two balls is sooner at the target? Either way takes two steps."""

from __future__ import annotations

from rich.console import Console

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.tools.benchmarks.planners.tours import Costs, compared
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep
from tailor.tools.lockstep.worlds import make_world

DOMAIN, SCENARIO = "soccer", "two-balls"
FIRST = 100  # seeds below were looked at during development
RUNS, QUICK_RUNS = 60, 2


def driven(seed: int, costs: Costs) -> Run:
    """One run of the scenario."""
    context = build_context(ExecutiveConfig(DOMAIN, SCENARIO, Settings(seed=seed, plan_costs=costs)), SENDER)
    return run_lockstep(context, make_world(context.domain.robot, SCENARIO, seed))


def run(console: Console, quick: bool) -> None:
    """Print one row for each way to choose."""
    console.print(compared("one of two balls to a target", driven, QUICK_RUNS if quick else RUNS, FIRST))
