"""The paper's Figure 15: valid places of an asserted subgoal and their cost, with the runs without and with it.

The approach that ships bends into its goal and needs no subgoal on an empty field (Figure 16), so the starts are those
of an approach among opponents. This evaluation selects the ones with an asserted subgoal.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.assertion.assertion import AFTER, BEFORE, succeeded, variants
from tailor.tools.evaluations.assertion.subgoal_map import SubgoalMap, subgoal_map_of
from tailor.tools.evaluations.assertion.subgoal_map_plot import draw_subgoal_map
from tailor.tools.evaluations.outcome import Outcome, Task
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import share_interval
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.evaluations.traced_runs import trace_run

SCENARIO = "opponents-approach"
COMPARED = variants()[:2]  # without assertion and with it
REMARKS = (
    "Above: predicted seconds by the subgoal's place, heading and speed there being the best of all; blank places are "
    "INVALID, because the way there or the approach from there is not sure enough to succeed. Below: that prediction "
    "(black line: the limit), and both runs. Square: start; grey cross and arrow: the subgoal as chosen; black arrow: "
    "the goal.",
    "Drawn: the first starts of the evaluation at which a subgoal was asserted, not picked.",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate figure15`."""
    add_count(parser, "--episodes", 2, 40, "starts to run")
    add_count(parser, "--drawn", 0, 2, "number of starts with a subgoal to draw")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run, draw and publish the report; 0 if more approaches succeed with their subgoals than without."""
    task = Task("soccer", SCENARIO, zoo=arguments.zoo)
    seeds = seeds_of(task.domain, arguments)
    starts = seeds.starts(arguments.episodes)
    found = run_all(task, COMPARED, starts, arguments.jobs, arguments.store, "figure 15")
    asserted = [seed for seed in starts if found[AFTER][seed].asserted]
    if not asserted:
        raise UsageError(f"--episodes {arguments.episodes}: no subgoal was asserted, expected more starts")
    rows = [_summary(found, asserted)]
    plots = {}
    for seed in asserted[: arguments.drawn]:
        row, ground = _looked_at(task, seed, found)
        rows.append(row)
        if ground is not None and arguments.report is not None:
            path = arguments.report / f"figure15-{seed}.png"
            plots[f"search space of the subgoal and both runs, start {seed}"] = _draw(task, seed, ground, path)
    title = "Figure 15: the search space of an asserted subgoal"
    publish_report(Report("figure15", title, rows, REMARKS, plots, seeds.provenance), arguments)
    return 0 if rows[0]["success_after_pct"] > rows[0]["success_before_pct"] else 1


def _summary(found: Mapping[str, Mapping[int, Outcome]], seeds: Sequence[int]) -> dict[str, Any]:
    """All starts at which a subgoal was asserted."""
    before, after = (sum(succeeded(found[name][seed]) for seed in seeds) for name in (BEFORE, AFTER))
    n = len(seeds)
    reached = [found[AFTER][seed] for seed in seeds if succeeded(found[AFTER][seed])]
    off = [_predicted_s(outcome) - outcome.duration_s for outcome in reached]
    return {
        "start": "all asserted",
        "n": n,
        "success_before_pct": 100 * before / n,
        "success_after_pct": 100 * after / n,
        "ci95_after": share_interval(after, n),
        "predicted_s": float(np.mean([_predicted_s(outcome) for outcome in reached])),
        "took_s": float(np.mean([outcome.duration_s for outcome in reached])),
        "bias_s": float(np.mean(off)),
    }


def _looked_at(
    task: Task, seed: int, found: Mapping[str, Mapping[int, Outcome]]
) -> tuple[dict[str, Any], SubgoalMap | None]:
    """One start with a subgoal; the ground is None if two subgoals were asserted in a row."""
    traced, context = trace_run(task, COMPARED[1], seed)
    ground = subgoal_map_of(traced.subgoals[0], context, traced.first_contexts)
    before, after = found[BEFORE][seed], found[AFTER][seed]
    row = {
        "start": str(seed),
        "n": 1,
        "success_before_pct": 100.0 * succeeded(before),
        "success_after_pct": 100.0 * succeeded(after),
        "predicted_s": _predicted_s(after),
        "took_s": after.duration_s if succeeded(after) else float("nan"),
        "contacts_before": before.costs.contacts,
        "contacts_after": after.costs.contacts,
    }
    if ground is not None:
        row |= {
            "valid_ground_pct": ground.valid_pct,
            "limit_of_failure_pct": 100 * ground.limit,
            "predicted_chosen_s": sum(ground.chosen_s),
            "predicted_least_s": ground.least_s,
        }
    return row, ground


def _draw(task: Task, seed: int, ground: SubgoalMap, path: Path) -> Path:
    tracks = []
    for variant, title in zip(COMPARED, ("without assertion", "with the subgoal"), strict=True):
        traced, _ = trace_run(task, variant, seed)
        contacts = traced.outcome.costs.contacts
        touched = f"{contacts} contact" if contacts == 1 else f"{contacts} contacts"
        result = "succeeded" if succeeded(traced.outcome) else f"failed, {touched}"
        tracks.append(replace(traced.track, title=f"{title} ({result})"))
    draw_subgoal_map(ground, tracks, f"start {seed}", path)
    return path


def _predicted_s(outcome: Outcome) -> float:
    """Predicted for the sequence as first chosen."""
    return sum(s for *_, s in outcome.predicted_actions)
