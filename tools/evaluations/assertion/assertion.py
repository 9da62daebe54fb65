"""Subgoal assertion among objects: success without it, with it, and by hand-made geometry, from equal starts."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import mean_interval, share_interval
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.evaluations.tick_budget import budget_remark, configure_tick_budget

SCENARIOS = {  # with objects, by domain
    "soccer": ("opponents", "opponents-approach", "opponents-dribble"),
    "kitchen": ("to-cupboard",),
}
DOMAINS = tuple(SCENARIOS)
BEFORE, AFTER, BASELINE = "before", "after", "baseline"
MIN_SUCCESS_PCT, MAX_SLOWER_PCT = 98.0, 8.0
REMARKS = (
    "before: the same controllers, nothing is predicted to fail. after: learned success, asserted subgoals. baseline: "
    "the same controllers on ways around the believed objects, from a graph of poses and of the ways that they drive.",
    "success: the goal is achieved, and nothing is touched on the way. needless: a subgoal was asserted, and before "
    "succeeds. slower: mean over starts, against before, where both succeed: all such starts, with a subgoal or "
    "without; needless slower: those with a needless subgoal; baseline needless slower: of the baseline from the same "
    "starts, where before may have been lucky.",
    "after to baseline: how much slower after is than the baseline where both succeed; 95 % intervals by start.",
)

Outcomes = Mapping[int, Outcome]  # by seed


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate assertion`."""
    add_count(parser, "--episodes", 2, 500, "starts of each scenario")
    parser.add_argument("--scenarios", nargs="+", metavar="NAME", help="scenarios (default: all with objects)")
    configure_tick_budget(parser)
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if every row reaches the targets."""
    domain = arguments.domain or DOMAINS[0]
    scenarios = list(dict.fromkeys(arguments.scenarios or SCENARIOS[domain]))
    unknown = [scenario for scenario in scenarios if scenario not in SCENARIOS[domain]]
    if unknown:  # before the runs of the others
        raise UsageError(f"--scenarios {unknown[0]}: expected some of: {', '.join(SCENARIOS[domain])}")
    seeds = seeds_of(domain, arguments)
    rows = []
    for scenario in scenarios:
        task = Task(domain, scenario, zoo=arguments.zoo, tick_ms=arguments.tick_ms)
        starts = seeds.starts(arguments.episodes)
        found = run_all(task, variants(), starts, arguments.jobs, arguments.store, scenario)
        rows.append({"scenario": scenario, **row(found, starts)})
    remarks = (*REMARKS, *budget_remark(arguments.tick_ms))
    report = Report("assertion", "Subgoal assertion among objects", rows, remarks, {}, seeds.provenance)
    publish_report(report, arguments)
    return 0 if all(map(reached, rows)) else 1


def variants() -> tuple[Variant, ...]:
    """Settings that are compared; without assertion nothing is predicted to fail, and failures cost nothing.

    The baseline heeds failures for other reasons than objects, such as a touched ball: a good engineer's would.
    """
    base = RefinementSettings()
    blind = replace(base, p_fail_max=1.0, p_fail_assert=1.0, risk_cost_s=0.0)
    return Variant(BEFORE, blind), Variant(AFTER, base), Variant(BASELINE, base, hand_made=True)


def row(found: Mapping[str, Outcomes], seeds: Sequence[int]) -> dict[str, Any]:
    """Figures of one scenario, in percent of all starts."""
    before, after, baseline = (found[name] for name in (BEFORE, AFTER, BASELINE))
    n = len(seeds)
    successes = {name: [seed for seed in seeds if succeeded(found[name][seed])] for name in found}
    needless = [seed for seed in successes[BEFORE] if after[seed].asserted]
    needless_slower, to_baseline = slower_pct(before, after, needless), slower_pct(baseline, after, seeds)
    slower = {name: slower_pct(before, found[name], successes[BEFORE]) for name in (AFTER, BASELINE)}
    return {
        "n": n,
        "success_before_pct": 100 * len(successes[BEFORE]) / n,
        "success_after_pct": 100 * len(successes[AFTER]) / n,
        "ci95_after": share_interval(len(successes[AFTER]), n),
        "needless_pct": 100 * len(needless) / n,
        "needless_slower_pct": needless_slower[0],
        "ci95_needless_slower": needless_slower[1],
        "baseline_needless_slower_pct": slower_pct(before, baseline, needless)[0],
        "baseline_success_pct": 100 * len(successes[BASELINE]) / n,
        "ci95_baseline": share_interval(len(successes[BASELINE]), n),
        "baseline_slower_pct": slower[BASELINE][0],
        "ci95_baseline_slower": slower[BASELINE][1],
        "after_slower_pct": slower[AFTER][0],
        "ci95_after_slower": slower[AFTER][1],
        "after_to_baseline_pct": to_baseline[0],
        "ci95_after_to_baseline": to_baseline[1],
        "asserted_pct": 100 * sum(after[seed].asserted for seed in seeds) / n,
        "lost_pct": 100 * len(set(successes[BEFORE]) - set(successes[AFTER])) / n,
        "contacts_after_pct": 100 * sum(after[seed].costs.contacts > 0 for seed in seeds) / n,
        "contacts_baseline_pct": 100 * sum(baseline[seed].costs.contacts > 0 for seed in seeds) / n,
    }


def succeeded(outcome: Outcome) -> bool:
    """Whether the goal was achieved without touching anything."""
    return outcome.achieved and outcome.costs.contacts == 0


def slower_pct(first: Outcomes, second: Outcomes, seeds: Sequence[int]) -> tuple[float, tuple[float, float]]:
    """Mean of how much longer the second takes where both succeed, and its 95 % interval; NaN for under two starts."""
    both = [seed for seed in seeds if succeeded(first[seed]) and succeeded(second[seed])]
    if len(both) < 2:
        return float("nan"), (float("nan"), float("nan"))
    more = np.array([100 * (second[seed].duration_s / first[seed].duration_s - 1) for seed in both])
    return float(more.mean()), mean_interval(more)


def reached(figures: Mapping[str, Any]) -> bool:
    """Whether a row reaches the targets; without needless subgoals they cost nothing."""
    slower = figures["needless_slower_pct"]
    return figures["success_after_pct"] >= MIN_SUCCESS_PCT and not slower > MAX_SLOWER_PCT
