"""Duration models by several learners on the same episodes: ours, scikit-learn's, and WEKA's M5P if installed."""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

from tailor.models.episodes.examples import duration_examples
from tailor.models.export.publishing import leaves
from tailor.models.features.features import FeatureSpace
from tailor.models.training import learners
from tailor.models.training.training import fit
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.models import fresh, weka
from tailor.tools.evaluations.models.learned import configure_learned, configure_train, feature_space_of, seeded
from tailor.tools.evaluations.pages.report import Report, publish_report
from tailor.tools.evaluations.paired_comparison import mean_over_runs
from tailor.tools.evaluations.progress import tracked


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate duration-learners`."""
    configure_learned(parser, 1000)
    parser.add_argument("--actions", nargs="+", default=["goToPose", "dribbleBall"], help="(default %(default)s)")
    configure_train(parser)
    add_count(parser, "--ticks", 1, 5, "first ticks of each, n_i")


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; exit code 0.

    Raises:
      UsageError: No such robot or action, or no episode of one finished.
    """
    arguments = seeded(arguments)
    spaces = {action: feature_space_of(arguments.robot, action) for action in arguments.actions}
    rows = [row for action, space in spaces.items() for row in _rows(action, space, arguments)]
    remarks = [f"{arguments.train} training episodes, {arguments.ticks} ticks each, seed {arguments.seed}; fresh runs"]
    report = Report("duration-learners", "Duration learners", rows, remarks, {}, arguments.provenance)
    publish_report(report, arguments)
    return 0


def _rows(action: str, space: FeatureSpace, arguments: argparse.Namespace) -> list[dict[str, Any]]:
    more = arguments.seed, arguments.jobs, arguments.store
    gathered = fresh.training(arguments.robot, action, arguments.train, *more)
    train = duration_examples(fresh.finished(action, gathered), arguments.ticks)
    unseen = fresh.evaluation(arguments.robot, action, arguments.episodes, *more)
    test = duration_examples(fresh.finished(action, unseen), 1)
    rows = []
    for name in tracked(list(learners.DURATION_LEARNERS), f"{action}: learners"):
        started = time.perf_counter()
        model = fit("duration", name, train, space, arguments.seed)
        seconds = time.perf_counter() - started
        off = model.predict(space(test.arguments)) - test.targets
        rows.append(_row(action, name, off, sum(leaves(model)), seconds, arguments.seed))
    if weka.installed():
        predicted, count, seconds = weka.m5p(space(train.arguments), train.targets, space(test.arguments))
        rows.append(_row(action, "WEKA M5P", predicted - test.targets, count, seconds, arguments.seed))
    return rows


def _row(action: str, name: str, off: Any, count: int, seconds: float, seed: int) -> dict[str, Any]:
    mae, ci = mean_over_runs(np.abs(off), range(len(off)), seed)
    return {
        "action": action,
        "learner": name,
        "mae_s": mae,
        "mae_ci95": ci,
        "bias_s": float(off.mean()),
        "leaves": count or "",
        "fit_s": seconds,
    }
