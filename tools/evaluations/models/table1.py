"""The paper's Table 1: for every action, episodes, mean duration and the duration model's error on fresh episodes."""

from __future__ import annotations

import argparse
from typing import Any

from tailor.tools.evaluations.models import model_rows

DOMAINS = ("soccer", "arm")
PAPER: dict[tuple[str, str], tuple[float, float, float]] = {  # episodes, mean duration, MAE (simulated where both)
    ("soccer", "goToPose"): (750, 6.2, 0.22),
    ("soccer", "dribbleBall"): (750, 7.4, 0.29),
    ("arm", "reach"): (1100, 2.9, 0.21),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table1`."""
    model_rows.configure(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if no action's relative error is worse than the paper's."""
    made = [row | _paper(row) for row in model_rows.rows(arguments.domain or DOMAINS[0], arguments)]
    remarks = ["paper: section 5.3.1, Table 1; relative: MAE over mean duration", *model_rows.REMARKS]
    model_rows.publish("table1", "Table 1: duration models", made, remarks, arguments)
    known = [row for row in made if "paper_mae_s" in row]
    return 0 if all(row["relative_pct"] <= row["paper_relative_pct"] for row in known) else 1


def _paper(row: dict[str, Any]) -> dict[str, float]:
    """The paper's figures for an action; empty where it has none."""
    if (row["domain"], row["action"]) not in PAPER:
        return {}
    count, mean_s, mae_s = PAPER[row["domain"], row["action"]]
    figures = {"paper_episodes": count, "paper_mean_duration_s": mean_s, "paper_mae_s": mae_s}
    return figures | {"paper_relative_pct": 100 * mae_s / mean_s}
