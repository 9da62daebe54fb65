"""The paper's Table 1: for every action, episodes, mean duration and the duration model's error on fresh episodes."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from tailor.models.episodes.episodes import DataSet
from tailor.models.episodes.examples import duration_examples
from tailor.models.runtime import OnnxDuration, load_robot
from tailor.models.training import scores
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.models.learned import configure_learned
from tailor.tools.evaluations.report import Report, publish_report

# robot, action -> training episodes, mean duration and MAE in seconds (paper Table 1, simulated where there are both)
PAPER: dict[tuple[str, str], tuple[float, float, float]] = {  # episodes, mean duration, MAE
    ("agilo", "goToPose"): (750, 6.2, 0.22),
    ("agilo", "dribbleBall"): (750, 7.4, 0.29),
    ("b21", "goToPose"): (2200, 9.0, 0.52),
    ("b21", "reach"): (2200, 2.6, 0.10),
    ("powercube", "reach"): (1100, 2.9, 0.21),
}
DOMAINS = ("soccer", "arm")


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate table1`."""
    configure_learned(parser, 1000)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if no action's relative error is worse than the paper's."""
    loaded, _ = load_robot(arguments.robot, Path(arguments.zoo) if arguments.zoo else None)
    models = [model for _, model in sorted(loaded.items()) if model.card["kind"] == "duration"]  # not energies
    rows = [row(model, arguments) for model in models]
    plots = _plots(models, arguments) if arguments.report else {}
    remarks = ["paper: section 5.3.1, Table 1; relative: MAE over mean duration; floor: repeated runs with other noise"]
    publish_report(Report("table1", "Table 1: duration models", rows, remarks, plots), arguments.json, arguments.report)
    known = [r for r in rows if r["paper_mae_s"] is not None]
    return 0 if all(r["relative_pct"] <= r["paper_relative_pct"] for r in known) else 1


def row(model: OnnxDuration, arguments: argparse.Namespace) -> dict[str, Any]:
    """The figures of one action; None for the paper's where it has none."""
    robot, action = model.card["robot"], model.card["action"]
    data = _fresh(model, arguments)
    mae, ci, bias = error(model, data, arguments.seed)
    mean = float(np.mean([episode.duration_s for episode in data.episodes if episode.finished]))
    figures = {
        "robot": robot,
        "action": action,
        "training_episodes": model.card["episodes"]["finished"],
        "episodes": len(data.episodes),
        "mean_duration_s": mean,
        "mae_s": mae,
        "mae_ci95": ci,
        "bias_s": bias,
        "floor_s": fresh.noise_floor(robot, action, arguments.seed, arguments.jobs)["mae_s"],
        "relative_pct": 100 * mae / mean,
    }
    count, paper_mean, paper_mae = PAPER.get((robot, action), (None, None, None))
    figures |= {"paper_episodes": count, "paper_mean_duration_s": paper_mean, "paper_mae_s": paper_mae}
    return {**figures, "paper_relative_pct": 100 * paper_mae / paper_mean if paper_mae and paper_mean else None}


def _fresh(model: OnnxDuration, arguments: argparse.Namespace) -> DataSet:
    robot, action = model.card["robot"], model.card["action"]
    return fresh.evaluation(robot, action, arguments.episodes, arguments.seed, arguments.jobs, arguments.store)


def _plots(models: list[OnnxDuration], arguments: argparse.Namespace) -> dict[str, Path]:
    from tailor.tools.figures import learned_reports

    predicted, observed = {}, {}
    for model in models:
        finished = [episode for episode in _fresh(model, arguments).episodes if episode.finished]
        rows = duration_examples(finished, 1)
        predicted[model.card["action"]] = model.predict(rows.arguments)[0]
        observed[model.card["action"]] = rows.targets
    path = learned_reports.scatter(arguments.report / "table1.png", predicted, observed)
    return {"predicted against observed, fresh episodes": path}


def error(model: OnnxDuration, data: DataSet, seed: int) -> tuple[float, tuple[float, float], float]:
    """MAE in seconds with its 95 % interval over episodes, and bias (predicted minus observed)."""
    rows = duration_examples([episode for episode in data.episodes if episode.finished], 1)
    off = model.predict(rows.arguments)[0] - rows.targets
    mae, ci = scores.mean_with_ci(np.abs(off), np.random.default_rng(seed))
    return mae, ci, float(off.mean())
