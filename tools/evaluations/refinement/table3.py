"""The paper's Table 3: greedy (h = 1) against refined (h = 2) from equal starts, and the gain of an oracle."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from tailor.executive import domains
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.arm import letters
from tailor.tools.evaluations.outcome import FIRST_SEED, Outcome, Task, Variant
from tailor.tools.evaluations.paired_comparison import compare
from tailor.tools.evaluations.plots import draw_pairs
from tailor.tools.evaluations.refinement.baselines import against_oracle, bias_s
from tailor.tools.evaluations.refinement.oracle import simulate_choices, subgoal_parameters
from tailor.tools.evaluations.refinement.replicas import Recipe, configure_replicas, over_models, replica
from tailor.tools.evaluations.report import Report, configure_report, publish_report
from tailor.tools.evaluations.task_runs import paired, run_all

# word on the command line -> domain, scenario, profile of the body, what the paper reports (means at h = 1 and 2, gain)
SCENARIOS = {
    "soccer": ("soccer", "approach-dribble", "", "9.8 s, 9.1 s, 6.6 %"),
    "degraded": ("soccer", "approach-dribble", "degraded", "the real robot: 10.6 s, 9.9 s, 6.1 %, n = 100"),
    "arm": ("arm", "every letter", "", "10.6 s, 10.0 s, 5.7 %, p = 0.08, n = 4"),
}
DOMAINS = {"soccer": ["soccer", "degraded"], "arm": ["arm"]}  # scenarios of each, in the order in which they are run
REMARKS = [
    "greedy: by the models, h = 1; oracle_greedy: the choice whose first action really ends soonest; zero: all free "
    "parameters zero; oracle: the best of all simulated choices, the ceiling; oracle_again: its choices executed again "
    "with other noise; share_of_oracle: of the ceiling's gain; bias: predicted minus actual duration of an action",
]


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table3`."""
    parser.add_argument("scenarios", nargs="*", help=f"of: {', '.join(SCENARIOS)} (default: all of the domain)")
    parser.add_argument("--episodes", type=at_least(2, "--episodes"), default=500, help="pairs (default %(default)s)")
    parser.add_argument(
        "--oracle",
        type=at_least(0, "--oracle"),
        default=50,
        metavar="N",
        help="starts at which every choice is simulated",
    )
    parser.add_argument(
        "--points", type=at_least(2, "--points"), default=18, help="angles that the oracle tries (default %(default)s)"
    )
    parser.add_argument(
        "--degraded", action="store_true", help="soccer with the stand-in real robot's noise and friction"
    )
    configure_replicas(parser)
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if every scenario improved significantly."""
    scenarios = arguments.scenarios or DOMAINS[arguments.domain or "soccer"]
    unknown = [name for name in scenarios if name not in SCENARIOS]
    if unknown:
        raise UsageError(f"unknown scenario '{unknown[0]}' for table3, expected one of: {', '.join(SCENARIOS)}")
    rows, plots = [], {}
    for name in scenarios:
        row, durations = evaluate(name, arguments)
        rows += [row | ({"model": "as shipped"} if arguments.models else {}), *_of_other_models(name, arguments)]
        if arguments.report is not None:
            plots[f"{name}: greedy and refined"] = draw_pairs(*durations, arguments.report / f"table3-{name}.png")
    remarks = [f"paper, {name}: {SCENARIOS[name][3]}" for name in scenarios] + REMARKS
    publish_report(
        Report("table3", "Table 3: subgoal refinement", rows, remarks, plots), arguments.json, arguments.report
    )
    each = [row for row in rows if "least_pct" not in row]  # not those over several models
    return 0 if all(row["p_value"] < 0.001 and row["improvement_pct"] > 0 for row in each) else 1


def _of_other_models(name: str, arguments: argparse.Namespace) -> list[dict[str, Any]]:
    """A row for each set of models that was trained anew, and one over all of them; without the oracle."""
    domain = SCENARIOS[name][0]
    recipe = Recipe(domain, domains.load(domain).robot, arguments.model_episodes, arguments.model_runs)
    rows = []
    for number in range(1, arguments.models + 1):
        zoo = replica(recipe, number, arguments.store, arguments.jobs)
        settings_of_model = argparse.Namespace(**{**vars(arguments), "zoo": str(zoo), "oracle": 0})
        rows.append({**evaluate(name, settings_of_model)[0], "model": f"trained anew, {number}"})
    return [*rows, over_models(rows)] if rows else []


def evaluate(
    name: str, arguments: argparse.Namespace, settings: RefinementSettings | None = None
) -> tuple[dict[str, Any], tuple[list[float], list[float]]]:
    """One row of the table, and the durations of greedy and refined episodes."""
    if name == "arm":
        return letters.table3_row(arguments)
    domain, scenario, profile, _ = SCENARIOS[name]
    task = Task(domain, scenario, "degraded" if arguments.degraded else profile, arguments.zoo)
    base = settings or RefinementSettings()
    variants = [Variant(f"h{h}", replace(base, horizon=h)) for h in (1, 2)]
    seeds = range(FIRST_SEED, FIRST_SEED + arguments.episodes)
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, name)
    greedy, refined = found["h1"], found["h2"]
    row = {"scenario": name + (" (degraded)" if arguments.degraded else ""), **_summary(greedy, refined)}
    if arguments.oracle:
        example = next(outcome for outcome in greedy.values() if outcome.achieved)
        judged = simulate_choices(
            task, subgoal_parameters(example), seeds[: arguments.oracle], base, arguments.points, arguments.jobs,
            arguments.store,
        )  # fmt: skip
        row |= against_oracle(judged, greedy, refined)
    return row, paired(greedy, refined)


def _summary(greedy: Mapping[int, Outcome], refined: Mapping[int, Outcome]) -> dict[str, Any]:
    """The figures of one scenario, over the seeds at which both achieved the goal."""
    comparison = compare(*paired(greedy, refined))
    return {
        "horizon": 2,
        "n": comparison.n,
        "mean_greedy_s": comparison.mean_baseline_s,
        "mean_refined_s": comparison.mean_s,
        **comparison.verdict,
        "failed_greedy": sum(not outcome.achieved for outcome in greedy.values()),
        "failed_refined": sum(not outcome.achieved for outcome in refined.values()),
        "bias_greedy_s": bias_s(greedy),
        "bias_refined_s": bias_s(refined),
    }
