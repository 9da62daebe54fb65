"""The paper's Figure 6 b: the same learner in its three feature spaces, and in one of ours with the turn besides."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from tailor.models.episodes.examples import Examples, duration_examples
from tailor.models.features.planar import projective, relative
from tailor.models.training.training import fit
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.models.learned import PAPER_EPISODES, configure_learned, feature_space_of, seeded
from tailor.tools.evaluations.pages.report import Report, publish_report
from tailor.tools.evaluations.paired_comparison import mean_over_runs
from tailor.tools.evaluations.progress import tracked

ORDER = ("direct", "relative", "projective", "projective-turn")
N_I = 5


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate feature-spaces`."""
    configure_learned(parser, 1000)
    parser.add_argument("--action", default="goToPose", help="which action (default %(default)s)")
    parser.add_argument("--learner", default="linear", help="see `tailor train` (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; 0 if the order is the paper's: direct, relative, projective.

    Raises:
      UsageError: No such robot, action or learner, or no episode finished.
    """
    arguments = seeded(arguments)
    common = arguments.robot, arguments.action
    spaces = {name: feature_space_of(*common, name) for name in ORDER}  # before any episode is gathered
    more = arguments.seed, arguments.jobs, arguments.store
    gathered = fresh.training(*common, PAPER_EPISODES, *more), fresh.evaluation(*common, arguments.episodes, *more)
    finished = [fresh.finished(arguments.action, data) for data in gathered]
    train, test = (duration_examples(some, n_i) for some, n_i in zip(finished, (N_I, 1), strict=True))
    rows: list[dict[str, Any]] = []
    for name, space in tracked(list(spaces.items()), "feature spaces"):
        learner = fit("duration", arguments.learner, train, space, arguments.seed)
        off = np.abs(learner.predict(space(test.arguments)) - test.targets)
        mae, ci = mean_over_runs(off, range(len(off)), arguments.seed)
        rows.append({"space": name, "dimensions": len(space.features), "mae_s": mae, "mae_ci95": ci})
    remarks = [f"{arguments.action}: {PAPER_EPISODES} training episodes, {arguments.episodes} fresh ones; {N_I} ticks"]
    plots = _plots(rows, test, arguments.report) if arguments.report else {}
    report = Report("feature-spaces", "Figure 6 b: feature spaces", rows, remarks, plots, arguments.provenance)
    publish_report(report, arguments)
    errors = [row["mae_s"] for row in rows[:3]]
    return 0 if errors == sorted(errors, reverse=True) else 1


def _plots(rows: list[dict[str, Any]], test: Examples, folder: Path) -> dict[str, Path]:
    from tailor.tools.figures.learned_models import reports

    columns: dict[str, Any] = {
        "direct: x [m]": test.arguments[:, 0],
        "relative: dx [m]": relative(test.arguments)[:, 0],
        "projective: dist [m]": projective(test.arguments)[:, 2],
    }
    names, errors, intervals = ([row[key] for row in rows] for key in ("space", "mae_s", "mae_ci95"))
    return {
        "error by feature space": reports.bars(folder / "feature-spaces.png", names, errors, intervals),
        "time against a feature of each": reports.against_features(folder / "figure6b.png", columns, test.targets),
    }
