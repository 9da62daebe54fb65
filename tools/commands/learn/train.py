"""Train action models from episodes: ONNX files with cards."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.table import Column, Table

from tailor.models.cards.card import SUCCESS_KINDS, UNITS
from tailor.models.cards.card_shape import TEST_FIGURES
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names, robot_names, spec_of_robot
from tailor.tools.cli.number_checks import at_least
from tailor.tools.cli.terminal import table_console
from tailor.tools.learning.card_lines import missed_failures
from tailor.tools.learning.changed_episodes import changed_episodes_warning
from tailor.tools.learning.model_folders import target_zoo
from tailor.tools.learning.other_choosers import other_choosers_warning
from tailor.tools.learning.recipe import MAX_SEED
from tailor.tools.learning.training_request import (
    DEFAULT_CLEARANCE_LEARNER,
    DEFAULT_FAILURE_LEARNER,
    DEFAULT_LEARNER,
    TrainingRequest,
)
from tailor.tools.learning.training_run import checked, train_models
from tailor.tools.parallel.progress_lines import ProgressLines

# named here so that --help loads no learning library
DURATION_LEARNERS = (
    "best, best-network, stack, bag, robust, distilled-tree, linear, m5, boosting, network, deep-network"
)
SUCCESS_LEARNERS = "distilled-forest, forest, distilled-tree, tree, boosting, network, networks, svm, constant"

EPILOG = """\
examples:
  tailor train agilo --data data/agilo
  tailor train agilo --data data/agilo --learner m5 --features relative --zoo out/zoo
  tailor train powercube

A data set is what `tailor gather` writes to DATA/ACTION. Each action gets a duration model, an energy model if its
episodes record the work of the drives, and a success model if the action names one or at least 2 % of them failed.
The test trains on three quarters of the episodes and reports errors on the last quarter. The published model is fitted
to all episodes."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    add = parser.add_argument
    add("robot", help="name of the robot, as in the manifests of the data sets")
    add("actions", nargs="*", default=[], metavar="ACTION", help="actions to train (default: all data sets)")
    add("--data", type=Path, nargs="+", default=[], help="folders with a data set per action (default: data/ROBOT)")
    add("--zoo", type=Path, metavar="DIR", help="folder to write models to (default: that of the robot)")
    add("--features", help="feature space (default: projective, or the one that fits the data's arguments)")
    add("--energy-features", help="feature space of energies (default: as --features; joints-relative for joints)")
    add("--learner", default=DEFAULT_LEARNER,
        help=f"learner of durations and energies: {DURATION_LEARNERS} (default: %(default)s)")  # fmt: skip
    add("--failure-learner", default=DEFAULT_FAILURE_LEARNER,
        help=f"learner of successes: {SUCCESS_LEARNERS} (default: %(default)s)")  # fmt: skip
    add("--clearance-learner", default=DEFAULT_CLEARANCE_LEARNER,
        help="learner of successes beside an object, one of the same (default: %(default)s)")  # fmt: skip
    add("--seed", type=at_least(0, "--seed"), default=1, help="random seed (default: %(default)s)")
    add("--json", action="store_true", help="print the test results as JSON, without progress bar")


def run(arguments: argparse.Namespace) -> int:
    """Train; exit code 0."""
    if arguments.robot in domain_names() and arguments.robot not in robot_names():
        spec_of_robot(arguments.robot)  # which names the robot of that domain; other names are those of data sets
    if arguments.seed > MAX_SEED:
        raise UsageError(f"--seed is {arguments.seed}, expected 0 to {MAX_SEED}")
    request = TrainingRequest(
        arguments.robot,
        target_zoo(arguments.zoo, arguments.robot),
        tuple(arguments.actions),
        tuple(arguments.data),
        arguments.features,
        arguments.energy_features,
        arguments.learner,
        arguments.failure_learner,
        arguments.seed,
        clearance_learner=arguments.clearance_learner,
    )
    request = checked(request)
    for warning in filter(None, (changed_episodes_warning(request), other_choosers_warning(request))):
        print(f"warning: {warning}", file=sys.stderr)
    rows = _trained(request, quiet=arguments.json)
    if arguments.json:
        print(json.dumps(rows))
    else:
        table_console().print(_table(rows))
        print(f"models in {request.zoo / request.robot}")
    return 0


def _trained(request: TrainingRequest, quiet: bool) -> list[dict[str, Any]]:
    """Rows of the trained models; a bar counts the actions, unless `quiet`."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    lines = ProgressLines(quiet)
    with lines.bars(*columns, transient=True) as progress:
        bar = progress.add_task("reading data sets", total=None)

        def on_action(action: str, number: int, total: int) -> None:
            lines.report(f"training {action}", number, total)
            progress.update(bar, description=f"training {action}", completed=number, total=total)

        return train_models(request, on_action)


def _table(rows: list[dict[str, Any]]) -> Table:
    table = Table(
        Column("model", no_wrap=True),
        "test episodes",
        "mean",
        "test MAE (95 % interval)",
        "accuracy",
        "missed failures",
    )
    for row in rows:
        table.add_row(f"{row['robot']}/{row['action']}/{row['kind']}", str(row["n"]), *_results(row))
    return table


def _results(row: dict[str, Any]) -> tuple[str, str, str, str]:
    """Mean, error, accuracy and missed failures; empty where the kind of model has none."""
    if row["kind"] in SUCCESS_KINDS:
        return "", "", f"{row['accuracy_pct']:.1f} %", missed_failures(row)
    (error, mean), unit = TEST_FIGURES[row["kind"]], UNITS[row["kind"]]
    low, high = row["mae_ci95"]
    return f"{row[mean]:.2f} {unit}", f"{row[error]:.3f} {unit} ({low:.3f} .. {high:.3f})", "", ""
