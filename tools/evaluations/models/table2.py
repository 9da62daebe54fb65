"""The paper's Table 2: how often the failure models are right, and how many failures they miss, on fresh episodes."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

from tailor.models.training.learners import COST_RATIO
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations.models import model_rows

PAPER = {"failure_accuracy_pct": 89.0, "missed_failures_pct": 1.0, "false_alarms_pct": 10.0, "failures_pct": 52.0}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table2`."""
    model_rows.configure(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if every model reaches the targets."""
    domain = arguments.domain or "soccer"
    made = [row for row in model_rows.rows(domain, arguments) if "failure_accuracy_pct" in row]
    if not made:
        raise UsageError(f"{domain} has no failure model, expected ACTION/success.onnx in its zoo")
    remarks = [f"paper, 750 episodes: {', '.join(f'{name} {value:g}' for name, value in PAPER.items())}"]
    model_rows.publish("table2", "Table 2: failure models", made, [*remarks, *model_rows.REMARKS], arguments)
    return 0 if all(map(reached, made)) else 1


def reached(row: Mapping[str, Any]) -> bool:
    """Whether at least 93 % are right, at most 1 % are missed failures, and a model that foresees none costs more.

    Where failures are rare, the first two hold of such a model, too.
    """
    failures, missed = row["failures_pct"], row["missed_failures_pct"]
    saves = COST_RATIO * missed + row["false_alarms_pct"] < COST_RATIO * failures
    return bool(row["failure_accuracy_pct"] >= 93 and missed <= 1 and (saves or not failures))
