"""Failure models by other learners (the paper's outlook, section 8): trees, forest, network, SVM, boosting, and J48."""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from tailor.models.episodes.examples import success_examples
from tailor.models.training import learners, scores
from tailor.models.training.training import fit
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations.models import fresh, weka
from tailor.tools.evaluations.models.learned import configure_learned, configure_train, feature_space_of, seeded
from tailor.tools.evaluations.pages.report import Report, publish_report
from tailor.tools.evaluations.progress import tracked


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate failure-learners`."""
    configure_learned(parser, 1000)
    parser.add_argument("--action", default="approachBall", help="which action (default %(default)s)")
    configure_train(parser)


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; exit code 0."""
    arguments = seeded(arguments)
    common = arguments.robot, arguments.action
    space = feature_space_of(*common)
    more = arguments.seed, arguments.jobs, arguments.store
    train = success_examples(fresh.training(*common, arguments.train, *more).episodes, 1)
    test = success_examples(fresh.evaluation(*common, arguments.episodes, *more).episodes, 1)
    if len(np.unique(train.targets)) < 2:
        raise UsageError(f"{arguments.action}: all training episodes ended alike, expected some failures to learn from")
    observed = test.targets > 0.5
    rows = []
    for name in tracked(list(learners.SUCCESS_LEARNERS), "learners"):
        model = fit("success", name, train, space, arguments.seed)
        rows.append(_row(name, model.predict_proba(space(test.arguments))[:, 1], model.threshold_, observed))
    if weka.installed():
        predicted = weka.j48(space(train.arguments), train.targets > 0.5, space(test.arguments), learners.COST_RATIO)
        rows.append(_row("WEKA J48", predicted.astype(float), 0.5, observed))
    ratio = f"a missed failure costs {learners.COST_RATIO:g} false alarms"
    remarks = [f"{arguments.action}: {arguments.train} training episodes, one example each; {ratio}; fresh runs"]
    report = Report("failure-learners", "Failure learners", rows, remarks, {}, arguments.provenance)
    publish_report(report, arguments)
    return 0


def _row(name: str, probability: Any, threshold: float, observed: Any) -> dict[str, Any]:
    table = scores.confusion(probability >= threshold, observed)
    return {
        "learner": name,
        "accuracy_pct": table.accuracy,
        "missed_failures_pct": table.success_fail,
        "false_alarms_pct": table.fail_success,
        "even_cost_accuracy_pct": scores.confusion(probability >= 0.5, observed).accuracy,
        "brier": float(np.mean((probability - observed) ** 2)),
        "n": table.n,
    }
