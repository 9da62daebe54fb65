"""The paper's Table 2: how often the failure models are right, and how many failures they miss, on fresh episodes."""

from __future__ import annotations

import argparse

from tailor.schemas.errors import UsageError
from tailor.tools.evaluations.models import model_rows

PAPER = {"failure_accuracy_pct": 89.0, "missed_failures_pct": 1.0, "false_alarms_pct": 10.0, "failures_pct": 52.0}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table2`."""
    model_rows.configure(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if at least 93 % are right and at most 1 % are failures that were missed."""
    domain = arguments.domain or "soccer"
    made = [row for row in model_rows.rows(domain, arguments) if "failure_accuracy_pct" in row]
    if not made:
        raise UsageError(f"{domain} has no failure model, expected ACTION/success.onnx in its zoo")
    remarks = [f"paper, 750 episodes: {', '.join(f'{name} {value:g}' for name, value in PAPER.items())}"]
    model_rows.publish("table2", "Table 2: failure models", made, [*remarks, *model_rows.REMARKS], arguments)
    return 0 if all(row["failure_accuracy_pct"] >= 93 and row["missed_failures_pct"] <= 1 for row in made) else 1
