"""The paper's Figure 16 b: ball approaches with and without subgoal assertion, success as predicted and as observed."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import Any

from tailor.executive.interfaces.reasons import Reason
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.assertion.assertion import AFTER, BEFORE, variants
from tailor.tools.evaluations.outcome import Outcome, Task
from tailor.tools.evaluations.pages.plots import draw_shares
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import compare, share_interval
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.lockstep.samplers.soccer_outcomes import COLLIDED_M

GOAL = "(atball pos2)"  # the approach alone
DRAWN = (("pos2", "phi", -math.pi, math.pi), ("pos2", "v", 0.0, 0.3))  # the goal state is random, as in the paper
PAPER = "paper: 47 % before, 97 % after, needless 10 % and 8 % slower there"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate figure16`."""
    add_count(parser, "--episodes", 2, 500, "approaches")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if at least 98 % succeed and at most 10 % have needless subgoals."""
    seeds = seeds_of("soccer", arguments)
    task = Task("soccer", "approach-dribble", "", arguments.zoo, GOAL, DRAWN)
    starts = seeds.starts(arguments.episodes)
    found = run_all(task, variants()[:2], starts, arguments.jobs, arguments.store, "figure 16")
    row = summary(found[BEFORE], found[AFTER])
    plots = {}
    if arguments.report is not None:
        plots["success of approaches"] = draw_shares(row, arguments.report / "figure16.png")
    report = Report("figure16", "Figure 16: subgoal assertion", [row], [PAPER], plots, seeds.provenance)
    publish_report(report, arguments)
    return 0 if row["success_after_pct"] >= 98 and row["needless_pct"] <= 10 else 1


def succeeded(outcome: Outcome) -> bool:
    """Whether the first approach reached the ball without bumping into it before."""
    first = next(
        (how for name, how in zip(outcome.actions, outcome.outcomes, strict=True) if name == "approachBall"), ""
    )
    return first == "done" and outcome.disturbance_m <= COLLIDED_M


def approached_s(outcome: Outcome) -> float:
    """Seconds until the first approach had ended, asserted subgoals included; what comes after it is not its doing."""
    return sum(outcome.actual_s[: outcome.actions.index("approachBall") + 1])


def summary(blind: dict[int, Outcome], asserted: dict[int, Outcome]) -> dict[str, Any]:
    """Shares in percent of all approaches."""
    seeds = sorted(set(blind) & set(asserted))
    n = len(seeds)

    def count(condition: Callable[[Outcome, Outcome], bool]) -> int:
        return sum(condition(blind[seed], asserted[seed]) for seed in seeds)

    after = count(lambda _, now: succeeded(now))
    needless = [s for s in seeds if asserted[s].asserted and succeeded(blind[s])]
    both = [s for s in needless if succeeded(asserted[s])]
    cost = (
        compare([approached_s(blind[s]) for s in both], [approached_s(asserted[s]) for s in both])
        if len(both) > 1
        else None
    )
    return {
        "n": n,
        "success_before_pct": 100 * count(lambda before, _: succeeded(before)) / n,
        "success_after_pct": 100 * after / n,
        "ci95_after": share_interval(after, n),
        "needless_pct": 100 * len(needless) / n,
        "needless_slower_pct": -cost.improvement_pct if cost else float("nan"),
        "asserted_pct": 100 * count(lambda _, now: now.asserted) / n,
        "predicted_fail_observed_fail_pct": 100 * count(lambda _, now: now.asserted and not succeeded(now)) / n,
        "predicted_fail_observed_success_pct": 100 * count(lambda _, now: now.asserted and succeeded(now)) / n,
        "predicted_success_observed_fail_pct": 100 * count(lambda _, now: not now.asserted and not succeeded(now)) / n,
        "predicted_success_observed_success_pct": 100 * count(lambda _, now: not now.asserted and succeeded(now)) / n,
        "no_subgoal_found": count(lambda _, now: Reason.NO_SUBGOAL in now.result),
    }
