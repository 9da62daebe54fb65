"""When not to refine (paper 6.3.2): the same fresh starts greedy, refined, and refined only where the tree says so.

The paper's tree was right in 87 % of the episodes and raised the improvement from 6.6 to 8.6 %.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.executive.composition import load_models
from tailor.executive.interfaces.models import RefinementGate
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.paired_comparison import compare, share_interval
from tailor.tools.evaluations.refinement.gate_ceiling import ceiling_of
from tailor.tools.evaluations.report import Report, configure_report, publish_report
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.learning import gathering

PAPER = "paper: 87 % right, improvement 6.6 % without and 8.6 % with the tree"
ROBOT, SCENARIO = "agilo", "approach-dribble"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate gate`."""
    parser.add_argument(
        "--episodes", type=at_least(2, "--episodes"), default=300, help="fresh starts, each run three ways"
    )
    parser.add_argument(
        "--repeated-starts", type=at_least(0, "--repeated-starts"), default=0, metavar="N",
        help="run N starts five times with other noise, which bounds any gate (default: %(default)s)",
    )  # fmt: skip
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if the tree loses no time and leaves fewer episodes slower."""
    row = evaluate(arguments)
    remarks = [PAPER, "right: kept greedy where refining was slower, refined where not; perfect: always right"]
    if arguments.repeated_starts:
        remarks.append("ceiling: predicted from four runs of the same start with other noise")
    publish_report(
        Report("gate", "When not to refine", [row], remarks, {}, seeds_of("soccer", arguments).provenance),
        arguments.json,
        arguments.report,
    )
    better = row["gated_pct"] >= row["improvement_pct"] and row["gated_slower_pct"] <= row["slower_pct"]
    return 0 if better else 1


def evaluate(arguments: argparse.Namespace, settings: RefinementSettings | None = None) -> dict[str, Any]:
    """The row of figures over fresh seeds.

    Raises:
      UsageError: No refinement gate in the zoo.
    """
    base = settings or RefinementSettings()
    tree = load_models(ROBOT, arguments.zoo, gated=True).gate
    if tree is None:
        raise UsageError(f"no refinement gate for {ROBOT}, expected one: `tailor train-gate {ROBOT}` makes it")
    plain = replace(base, gate=False)
    variants = [
        Variant("h1", replace(plain, horizon=1)),
        Variant("h2", replace(plain, horizon=2)),
        Variant("gated", replace(base, horizon=2, gate=True)),
    ]
    task = Task(gathering.domain_of(ROBOT), SCENARIO, "", arguments.zoo)
    seeds = seeds_of(task.domain, arguments).starts(arguments.episodes)
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, "gate")
    starts = [(found["h1"][seed], found["h2"][seed], found["gated"][seed]) for seed in seeds]
    ceiling = {}
    if arguments.repeated_starts:
        ceiling = ceiling_of(task, plain, seeds[: arguments.repeated_starts], arguments.jobs, arguments.store)
    return summary(starts, tree) | ceiling


def summary(starts: list[tuple[Outcome, Outcome, Outcome]], tree: RefinementGate) -> dict[str, Any]:
    """Figures of starts that were run greedy, refined, and with the tree; those that failed in any way are left out."""
    achieved = [start for start in starts if all(outcome.achieved for outcome in start)]
    greedy_s, refined_s, gated_s = (np.array([start[way].duration_s for start in achieved]) for way in range(3))
    kept = advised([refined for _, refined, _ in achieved], tree)
    slower = refined_s > greedy_s
    n, right = len(kept), int(np.sum(kept == slower))
    plain, gated = compare(greedy_s, refined_s), compare(greedy_s, gated_s)
    return {
        "n": n,
        "right_pct": 100 * right / n,
        "right_ci95": share_interval(right, n),
        "always_refining_right_pct": 100 * float(np.mean(~slower)),
        "kept_pct": 100 * float(kept.mean()),
        "improvement_pct": plain.improvement_pct,
        "ci95": plain.ci95,
        "gated_pct": gated.improvement_pct,
        "gated_ci95": gated.ci95,
        "perfect_pct": compare(greedy_s, np.minimum(greedy_s, refined_s)).improvement_pct,
        "p_gate": compare(refined_s, gated_s).p_value,
        "slower_pct": plain.slower_pct,
        "gated_slower_pct": gated.slower_pct,
        "lost_s": _lost_s(greedy_s, refined_s),
        "gated_lost_s": _lost_s(greedy_s, gated_s),
        "failed_refined": sum(not refined.achieved for _, refined, _ in starts),
        "failed_gated": sum(not outcome.achieved for _, _, outcome in starts),
    }


def advised(refined: list[Outcome], tree: RefinementGate) -> NDArray[np.bool_]:
    """Where the gate keeps the greedy choice, shape (n,), from the situations of runs without it."""
    kept = np.zeros(len(refined), np.bool_)
    reported = [place for place, outcome in enumerate(refined) if outcome.situation]
    if reported:
        kept[reported] = tree.p_slowdown(np.array([refined[place].situation for place in reported])) > tree.threshold
    return kept


def _lost_s(greedy_s: NDArray[np.float64], other_s: NDArray[np.float64]) -> float:
    """Seconds an episode, on average over all, that are lost where greedy would have been faster."""
    return float(np.maximum(other_s - greedy_s, 0.0).mean())
