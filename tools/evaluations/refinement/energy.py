"""Time against energy (paper 8): equal starts with increasing weights of energy; work is measured, not predicted."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count, finite
from tailor.tools.evaluations.costs import costs_of
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import compare, p_shown
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_task
from tailor.tools.parallel.pool import completed, in_order

WEIGHTS = (0.0, 0.3, 1.0, 3.0)  # seconds that a joule is worth; the first is compared with


@dataclass(frozen=True, slots=True)
class Cost:
    """Duration and energy of an episode."""

    achieved: bool
    duration_s: float
    energy_j: float


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate energy`."""
    parser.add_argument("--scenario", default="approach-dribble", help="soccer scenario (default %(default)s)")
    parser.add_argument(
        "--weights", type=finite("--weights"), nargs="+", default=list(WEIGHTS), help="s/J (default %(default)s)"
    )
    add_count(parser, "--episodes", 2, 60, "episodes a weight")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if the largest weight saves energy significantly."""
    if len(arguments.weights) < 2:
        raise UsageError(f"--weights {arguments.weights}: expected at least two, the first to compare with")
    task = Task("soccer", arguments.scenario, "", arguments.zoo)
    seeds = seeds_of(task.domain, arguments)
    starts = seeds.starts(arguments.episodes)
    wanted = [(weight, seed) for seed in starts for weight in arguments.weights]
    costs = in_order(completed(cost_of, [(task, weight, seed) for weight, seed in wanted], arguments.jobs))
    found = dict(zip(wanted, costs, strict=True))
    rows = [_row(weight, arguments.weights[0], starts, found) for weight in arguments.weights]
    remarks = [f"{arguments.scenario}: paired with weight {arguments.weights[0]:g}; energy is the work of the wheels"]
    publish_report(Report("energy", "Time against energy", rows, remarks, {}, seeds.provenance), arguments)
    largest = max(rows, key=lambda row: row["joule_worth_s"])
    return 0 if largest["energy_ci95"][0] > 0 else 1


def cost_of(task: Task, weight: float, seed: int) -> Cost:
    """Run one episode with a weight of energy in s/J."""
    variant = Variant(f"joule {weight:g}", RefinementSettings(energy_weight=weight))
    run, context = run_task(task, variant, seed)
    return Cost(run.achieved, run.duration_s, costs_of(run, context.domain).energy_j)


def _row(weight: float, first: float, seeds: Sequence[int], found: dict[tuple[float, int], Cost]) -> dict[str, Any]:
    both = [(found[first, seed], found[weight, seed]) for seed in seeds]
    both = [(a, b) for a, b in both if a.achieved and b.achieved]
    times = compare([a.duration_s for a, _ in both], [b.duration_s for _, b in both])
    work = compare([a.energy_j for a, _ in both], [b.energy_j for _, b in both])
    return {
        "joule_worth_s": weight,
        "n": len(both),
        "mean_s": times.mean_s,
        "mean_j": work.mean_s,
        "longer_pct": -times.improvement_pct,
        "longer_ci95": tuple(np.sort([-times.ci95[0], -times.ci95[1]]).tolist()),
        "energy_saved_pct": work.improvement_pct,
        "energy_ci95": work.ci95,
        "energy_p": p_shown(work.p_value),
        "failed": sum(not found[weight, seed].achieved for seed in seeds),
    }
