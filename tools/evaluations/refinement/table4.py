"""The paper's Table 4: the same sequences with growing horizons, each compared with the one before."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.outcome import FIRST_SEED, Outcome, Task, Variant
from tailor.tools.evaluations.paired_comparison import compare
from tailor.tools.evaluations.plots import draw_horizons
from tailor.tools.evaluations.refinement.baselines import bias_s
from tailor.tools.evaluations.report import Report, configure_report, publish_report
from tailor.tools.evaluations.task_runs import paired, run_all

# word on the command line -> domain, scenario, horizons, the paper's improvements of each over the one before
SCENARIOS = {"soccer": ("soccer", "waypoints", (1, 2, 3, 4), "10.6 %, 0.7 %, 0.2 %")}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table4`."""
    parser.add_argument("scenarios", nargs="*", help=f"of: {', '.join(SCENARIOS)} (default: soccer)")
    parser.add_argument(
        "--episodes", type=at_least(2, "--episodes"), default=200, help="episodes a horizon (default %(default)s)"
    )
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if h = 2 is significantly faster and longer horizons are not slower."""
    scenarios = arguments.scenarios or [arguments.domain or "soccer"]
    unknown = [name for name in scenarios if name not in SCENARIOS]
    if unknown:
        raise UsageError(f"unknown scenario '{unknown[0]}' for table4, expected one of: {', '.join(SCENARIOS)}")
    rows, remarks = [], []
    for name in scenarios:
        rows += evaluate(name, arguments)
        remarks.append(f"paper, {name}, each horizon over the one before: {SCENARIOS[name][3]}")
    plots = {}
    if arguments.report is not None:
        plots["improvement by horizon"] = draw_horizons(rows, arguments.report / "table4.png")
    publish_report(
        Report("table4", "Table 4: effect of the horizon", rows, remarks, plots), arguments.json, arguments.report
    )
    return 0 if _as_promised(rows) else 1


def evaluate(
    name: str, arguments: argparse.Namespace, settings: RefinementSettings | None = None
) -> list[dict[str, Any]]:
    """One row a horizon; improvements over h = 1 and over the horizon before."""
    domain, scenario, horizons, _ = SCENARIOS[name]
    task = Task(domain, scenario, "", arguments.zoo)
    base = settings or RefinementSettings()
    variants = [Variant(f"h{h}", replace(base, horizon=h)) for h in horizons]
    seeds = range(FIRST_SEED, FIRST_SEED + arguments.episodes)
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, name)
    return [_row(name, h, found["h1"], found[f"h{max(1, h - 1)}"], found[f"h{h}"]) for h in horizons]


def _row(
    name: str, horizon: int, greedy: dict[int, Outcome], shorter: dict[int, Outcome], these: dict[int, Outcome]
) -> dict[str, Any]:
    over_greedy, over_shorter = compare(*paired(greedy, these)), compare(*paired(shorter, these))
    return {
        "scenario": name,
        "horizon": horizon,
        "n": over_greedy.n,
        "mean_greedy_s": over_greedy.mean_baseline_s,
        "mean_refined_s": over_greedy.mean_s,
        **over_greedy.verdict,
        "over_shorter_pct": over_shorter.improvement_pct,
        "over_shorter_p": over_shorter.p_value,
        "failed": sum(not outcome.achieved for outcome in these.values()),
        "bias_s": bias_s(these),
    }


def _as_promised(rows: Sequence[dict[str, Any]]) -> bool:
    """h = 2 beats h = 1 with p < 0.001, and no longer horizon is significantly slower than the one before."""
    for row in rows:
        if row["horizon"] == 2 and not (row["improvement_pct"] > 0 and row["p_value"] < 0.001):
            return False
        if row["horizon"] > 2 and row["over_shorter_pct"] < 0 and row["over_shorter_p"] < 0.05:
            return False
    return True
