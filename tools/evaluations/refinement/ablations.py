"""Ablations of refinement: one part off at a time, paired with the default from the same starts."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count, at_least
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import (
    compare,
    compare_means,
    compare_shares,
    is_longer,
    p_shown,
    share_interval,
)
from tailor.tools.evaluations.refinement.replicas import Recipe, replica
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.learning.recipe_file import recipe_of

DEFAULT = RefinementSettings()
GREEDY = Variant("h1", replace(DEFAULT, horizon=1))
ABLATIONS = (
    Variant("default", DEFAULT),
    Variant("no spread", replace(DEFAULT, k_std=0.0)),
    Variant("exact arrivals", replace(DEFAULT, arrival_spread=())),
    Variant("risk price 0", replace(DEFAULT, risk_cost_s=0.0)),
    Variant("any gain", replace(DEFAULT, gain_k_std=0.0)),  # also one smaller than the models' deviation
)
REMARKS = (
    "improvement: over greedy with the same models; more: than the default, paired by start, in points; contacts and "
    "failures: share of all runs; n: starts from which all three achieved the goal",
    "trained anew: models of their own, with one on-policy round and without; both over greedy with the former",
)


@dataclass(frozen=True, slots=True)
class Judged:
    """Runs of one setting, with those that it is compared with; by seed."""

    greedy: Mapping[int, Outcome]
    default: Mapping[int, Outcome]
    runs: Mapping[int, Outcome]


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate ablations`."""
    parser.add_argument("--scenario", default="", help="of the domain (default: its first)")
    add_count(parser, "--episodes", 2, 300, "starts, each run with every setting")
    parser.add_argument("--model-episodes", type=at_least(0, "--model-episodes"), default=0, metavar="N",
                        help="train models of N random episodes, with on-policy data and without")  # fmt: skip
    add_count(parser, "--model-runs", 1, 200, "runs of their on-policy round", metavar="N")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if no ablation is significantly faster than the default."""
    domain = arguments.domain
    if not domain:
        raise UsageError("no domain named, expected --domain NAME")
    arguments.scenario = arguments.scenario or domains.scenarios(domain)[0]
    if arguments.model_episodes:
        recipe_of(domains.load(domain).robot)  # raises before anything runs
    seeds = seeds_of(domain, arguments)
    starts = seeds.starts(arguments.episodes)
    found = _run(domain, arguments.zoo, ABLATIONS, starts, arguments)
    rows = [row(name, Judged(found["h1"], found["default"], runs)) for name, runs in found.items() if name != "h1"]
    if arguments.model_episodes:
        rows += _without_policy(domain, starts, arguments)
    title = f"Ablations of refinement: {domain}, {arguments.scenario}"
    publish_report(Report("ablations", title, rows, REMARKS, {}, seeds.provenance), arguments)
    return 0 if all(made["improvement_more_ci95"][0] <= 0 for made in rows) else 1


def row(name: str, judged: Judged) -> dict[str, Any]:
    """Figures of one setting.

    Raises:
      UsageError: Fewer than two starts from which all achieved the goal.
    """
    seeds = sorted(judged.runs)
    reached = [s for s in seeds if all(some[s].is_timed for some in (judged.greedy, judged.default, judged.runs))]
    greedy_s, default_s, these_s = (
        np.array([some[seed].duration_s for seed in reached]) for some in (judged.greedy, judged.default, judged.runs)
    )
    times = compare(greedy_s, these_s)
    more = compare_means(100 * (1 - default_s / greedy_s), 100 * (1 - these_s / greedy_s))
    longer = is_longer(these_s, greedy_s)
    slower = compare_shares(is_longer(default_s, greedy_s), longer)
    return {
        "setting": name,
        "n": times.n,
        "mean_greedy_s": times.mean_baseline_s,
        "mean_s": times.mean_s,
        "improvement_pct": times.improvement_pct,
        "ci95": times.ci95,
        "improvement_more_points": more.second - more.first,
        "improvement_more_ci95": more.ci95,
        "improvement_more_p": p_shown(more.p_value),
        "slower_pct": slower.second,
        "slower_ci95": share_interval(int(np.sum(longer)), times.n),
        "slower_more_ci95": slower.ci95,
        "slower_more_p": p_shown(slower.p_value),
        "lost_s": float(np.maximum(these_s - greedy_s, 0.0).mean()),
        "failures_pct": 100 * float(np.mean([not judged.runs[seed].achieved for seed in seeds])),
        "contacts_pct": 100 * float(np.mean([judged.runs[seed].costs.contacts > 0 for seed in seeds])),
    }


def _without_policy(domain: str, starts: Sequence[int], arguments: argparse.Namespace) -> list[dict[str, Any]]:
    """Rows of models with an on-policy round, and of the same without it."""
    recipe = Recipe(domain, (arguments.scenario,), arguments.model_episodes, arguments.model_runs)
    made = replica(recipe, 1, arguments.store, arguments.jobs)
    both, random = (_run(domain, zoo, ABLATIONS[:1], starts, arguments) for zoo in (made.zoo, made.chooser(0)))
    default = both["default"]
    return [
        row("trained anew", Judged(both["h1"], default, default)),
        row("trained anew, no on-policy data", Judged(both["h1"], default, random["default"])),
    ]


def _run(
    domain: str, zoo: str | Path, variants: Sequence[Variant], starts: Sequence[int], arguments: argparse.Namespace
) -> dict[str, dict[int, Outcome]]:
    task = Task(domain, arguments.scenario, "", str(zoo))
    return run_all(task, [GREEDY, *variants], starts, arguments.jobs, arguments.store, "ablations")
