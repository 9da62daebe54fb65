"""The paper's Table 2: which approaches the failure model predicts to fail, and which do, over fresh runs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from tailor.models.episodes.examples import success_examples
from tailor.models.runtime import OnnxSuccess, load_robot
from tailor.models.training import scores
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.models.learned import configure_learned
from tailor.tools.evaluations.report import Report, publish_report

PAPER = {"fail_fail": 51.0, "fail_success": 10.0, "success_fail": 1.0, "success_success": 38.0, "accuracy_pct": 89.0}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table2`."""
    configure_learned(parser, 1000)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if at least 93 % are right and at most 1 % are failures that were missed."""
    _, successes = load_robot(arguments.robot, Path(arguments.zoo) if arguments.zoo else None)
    if not successes:
        raise UsageError(f"{arguments.robot} has no failure model, expected ACTION/success.onnx in its zoo")
    rows = [row(model, arguments) for model in successes.values()]
    rows.append({"model": "paper", **PAPER, "n": 1000})
    remarks = [
        "cells: predicted_observed, percent of runs",
        "floor_accuracy_pct: how often the same task ends as it mostly does, over repeated runs with other noise",
    ]
    publish_report(Report("table2", "Table 2: failure models", rows, remarks), arguments.json, arguments.report)
    return 0 if all(r["accuracy_pct"] >= 93 and r["success_fail"] <= 1 for r in rows[:-1]) else 1


def row(model: OnnxSuccess, arguments: argparse.Namespace) -> dict[str, Any]:
    """The figures of one failure model."""
    robot, action = model.card["robot"], model.card["action"]
    data = fresh.evaluation(robot, action, arguments.episodes, arguments.seed, arguments.jobs, arguments.store)
    examples = success_examples(data.episodes, 1)
    probability, observed = model.probability(examples.arguments), examples.targets > 0.5
    table = scores.confusion(probability >= model.threshold, observed)
    even = scores.confusion(probability >= 0.5, observed)
    floor = fresh.noise_floor(robot, action, arguments.seed, arguments.jobs)
    return {
        "model": f"{robot}/{action}",
        "fail_fail": table.fail_fail,
        "fail_success": table.fail_success,
        "success_fail": table.success_fail,
        "success_success": table.success_success,
        "accuracy_pct": table.accuracy,
        "n": table.n,
        "even_cost_accuracy_pct": even.accuracy,
        "floor_accuracy_pct": floor["accuracy_pct"],
        "brier": float(np.mean((probability - observed) ** 2)),
    }
