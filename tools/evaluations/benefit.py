"""When not to refine (paper 6.3.2): a decision tree on what refinement predicts, learned on other episodes.

The paper's tree was right in 87 % of the episodes and raised the improvement from 6.6 to 8.6 %.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.tree import DecisionTreeClassifier, export_text

from executive.refinement.settings import RefinementSettings
from tools.evaluations.comparison import compare
from tools.evaluations.outcome import Outcome, Task, Variant
from tools.evaluations.report import Report, configure_report, tell
from tools.evaluations.table3 import FIRST_SEED
from tools.evaluations.trials import run_all

TRAINING_SEED = 700_000  # episodes that the tree is learned from; never evaluated on
FEATURES = ("gain_s", "gain_pct", "greedy_s", "turned_rad", "speed_mps")
Table = NDArray[np.float64]


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate benefit`."""
    parser.add_argument("--episodes", type=int, default=300, help="pairs to learn from, and as many to judge by")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Learn, judge and tell; 0 when the gate loses nothing."""
    row, rules = evaluate(arguments)
    remarks = ["paper: 87 % right, 6.6 % to 8.6 %", f"rules (refine where the class is 1):\n{rules}"]
    tell(Report("benefit", "When not to refine", [row], remarks), arguments.json, arguments.report)
    return 0 if row["gated_pct"] >= row["improvement_pct"] else 1


def evaluate(arguments: argparse.Namespace, settings: RefinementSettings | None = None) -> tuple[dict[str, Any], str]:
    """The row of figures over fresh seeds, and the tree as text."""
    base = settings or RefinementSettings()
    learned_from = _pairs(TRAINING_SEED, arguments, base)
    judged_by = _pairs(FIRST_SEED, arguments, base)
    tree = DecisionTreeClassifier(max_leaf_nodes=4, min_samples_leaf=15, random_state=0)  # four rules, as the paper's
    features, greedy_s, refined_s = _table(learned_from)
    # An episode that loses much matters more than one that loses a tick: weigh by what is at stake.
    tree.fit(features, refined_s <= greedy_s, sample_weight=np.abs(refined_s - greedy_s) + 0.05)
    fresh, greedy_s, refined_s = _table(judged_by)
    chosen = tree.predict(fresh).astype(bool)
    gated_s = np.where(chosen, refined_s, greedy_s)
    plain, gated, perfect = (compare(greedy_s, s) for s in (refined_s, gated_s, np.minimum(greedy_s, refined_s)))
    row = {
        "n": plain.n,
        "right_pct": 100 * float(np.mean(chosen == (refined_s <= greedy_s))),
        "refined_pct": 100 * float(chosen.mean()),
        "improvement_pct": plain.improvement_pct,
        "gated_pct": gated.improvement_pct,
        "gated_ci95": gated.ci95,
        "perfect_gate_pct": perfect.improvement_pct,
        "slower_pct": plain.slower_pct,
        "gated_slower_pct": gated.slower_pct,
    }
    return row, export_text(tree, feature_names=list(FEATURES))


def _pairs(first_seed: int, arguments: argparse.Namespace, base: RefinementSettings) -> list[tuple[Outcome, Outcome]]:
    task = Task("soccer", "approach-dribble", "", arguments.zoo)
    variants = [Variant(f"h{h}", replace(base, horizon=h)) for h in (1, 2)]
    seeds = range(first_seed, first_seed + arguments.episodes)
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, "benefit")
    pairs = [(found["h1"][seed], found["h2"][seed]) for seed in seeds]
    return [(greedy, refined) for greedy, refined in pairs if greedy.achieved and refined.achieved and greedy.free]


def _table(pairs: list[tuple[Outcome, Outcome]]) -> tuple[Table, Table, Table]:
    """Features of each pair, shape (n, 5), and both durations, shapes (n,)."""
    rows = [_features(greedy, refined) for greedy, refined in pairs]
    greedy_s, refined_s = ([pair[i].duration_s for pair in pairs] for i in (0, 1))
    return np.nan_to_num(np.array(rows), posinf=99.0), np.array(greedy_s), np.array(refined_s)


def _features(greedy: Outcome, refined: Outcome) -> tuple[float, ...]:
    """What is known before the first action starts: the predicted gain, and how far the choices are apart."""
    gain_s = refined.greedy_cost_s - refined.refined_cost_s
    apart = {
        quantity: abs(one[4] - other[4])
        for one, other in zip(greedy.free, refined.free, strict=False)
        for quantity in [one[1]]
        if one[:2] == other[:2]
    }
    turned = apart.get("phi", 0.0)
    return (
        gain_s,
        100 * gain_s / refined.greedy_cost_s,
        refined.greedy_cost_s,
        min(turned, 2 * np.pi - turned),
        apart.get("v", 0.0),
    )
