"""Rows of evaluations of action models on fresh episodes: errors, noise floor, missed failures, coverage."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.models import Models
from tailor.models.episodes.episodes import DataSet
from tailor.models.episodes.examples import duration_examples, success_examples
from tailor.models.inference import OnnxDuration, OnnxSuccess
from tailor.models.runtime import load_robot
from tailor.models.training import scores
from tailor.schemas.installed import models_folder
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.models.coverage import coverage_columns, predicted_by
from tailor.tools.evaluations.models.floors import floor_columns
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import mean_over_runs
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.seeds import seeds_of

Row = dict[str, Any]
REMARKS = (
    "MAE: of the fresh episodes that finished, 95 % interval over runs; bias: predicted minus observed; noise "
    "floor: repeated runs of the first 1000 of these tasks with other noise; over floor: the error on the same tasks "
    "as a multiple of it, bootstrap over tasks; failures: predicted and observed, of all fresh episodes; "
    "constant accuracy: of who always predicts the more frequent outcome; "
    "coverage: share of durations within the interval that is to hold 90 %, and in thirds of predicted spread",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags that `tailor evaluate models` and its names for the paper's tables share."""
    add_count(parser, "--episodes", 6, 1000, "fresh episodes of each action")
    configure_report(parser)


def publish(name: str, title: str, made: Sequence[Row], remarks: Sequence[str], arguments: argparse.Namespace) -> None:
    """Publish the rows of a domain's models under a name."""
    plots = _plot(name, made, arguments.report) if arguments.report is not None else {}
    shown = [{key: value for key, value in row.items() if key not in ("predicted_s", "observed_s")} for row in made]
    domain = arguments.domain or next(iter(made))["domain"]
    provenance = seeds_of(domain, arguments).provenance
    publish_report(Report(name, title, shown, remarks, plots, provenance), arguments)


def rows(domain: str, arguments: argparse.Namespace, floors: bool = True) -> list[Row]:
    """A row for each action with a duration model.

    Args:
      domain: Name of the domain.
      arguments: As `configure` declares them.
      floors: Also measure the noise floors, which do not depend on the models.

    Raises:
      UsageError: No such domain, its models are missing or altered, or no episode of an action finished.
    """
    declared = domains.load(domain)
    zoo = Path(arguments.zoo) if arguments.zoo else models_folder(declared.robot)
    durations, successes = load_robot(declared.robot, zoo)
    seed = seeds_of(domain, arguments).first
    made = []
    for name, action in tracked(sorted(declared.actions.items()), "actions"):
        data = fresh.evaluation(declared.robot, name, arguments.episodes, seed, arguments.jobs, arguments.store)
        fresh.finished(name, data)
        row = {"domain": domain, "action": name, **duration_columns(durations, action.duration_model, data, seed)}
        row |= _failures(successes[action.success_model], data) if action.success_model else {}
        row |= floor_columns(row, data, (declared.robot, name, seed, arguments.jobs)) if floors else {}
        made.append(row)
    return made


def duration_columns(
    durations: Mapping[str, OnnxDuration], path: str, data: DataSet, seed: int, per_run: int = 1
) -> Row:
    """Errors and coverage of an action's duration model, on the finished episodes of a data set.

    Args:
      durations: The robot's models by path.
      path: `Action.duration_model`; episodes in a context are predicted by the model beside objects, if there is one.
      data: Episodes of that action, at least one of them finished.
      seed: Random seed of the bootstrap of `mae_ci95`, over runs.
      per_run: Numbers that the episodes of one run share: those of a run are not independent.
    """
    finished = [episode for episode in data.episodes if episode.finished]
    examples = duration_examples(finished, 1)
    in_context = np.array([episode.in_context for episode in finished])
    beside = durations[Models(durations, {}).duration_path(path, in_context=True)]
    predicted = predicted_by(durations[path], beside, examples.arguments, in_context)
    off = predicted.mean_s - examples.targets
    runs = [episode.number // per_run for episode in finished]
    mae, ci = mean_over_runs(np.abs(off), runs, seed)
    mean = float(examples.targets.mean())
    return {
        "training_episodes": durations[path].card["episodes"]["finished"],
        "episodes": len(data.episodes),
        "mean_duration_s": mean,
        "mae_s": mae,
        "mae_ci95": ci,
        "bias_s": float(off.mean()),
        "relative_pct": 100 * mae / mean,
        **coverage_columns(predicted, examples.targets),
        "predicted_s": predicted.mean_s,
        "observed_s": examples.targets,
    }


def _failures(model: OnnxSuccess, data: DataSet) -> Row:
    examples = success_examples(data.episodes, 1)
    probability, observed = model.probability(examples.arguments), examples.targets > 0.5
    table = scores.confusion(probability >= model.threshold, observed)
    failures_pct = table.fail_fail + table.success_fail
    return {
        "failure_accuracy_pct": table.accuracy,
        "constant_accuracy_pct": max(failures_pct, 100 - failures_pct),
        "missed_failures_pct": table.success_fail,
        "false_alarms_pct": table.fail_success,
        "failures_pct": failures_pct,
        "even_cost_accuracy_pct": scores.confusion(probability >= 0.5, observed).accuracy,
        "brier": float(np.mean((probability - observed) ** 2)),
    }


def _plot(name: str, made: Sequence[Row], folder: Path) -> Mapping[str, Path]:
    from tailor.tools.figures.learned_models import reports

    named = {", ".join(filter(None, (row["action"], row.get("chosen_in", "")))): row for row in made}
    predicted, observed = ({each: row[key] for each, row in named.items()} for key in ("predicted_s", "observed_s"))
    path = reports.scatter(folder / f"{name}.png", predicted, observed)
    return {"predicted against observed, fresh episodes": path}
