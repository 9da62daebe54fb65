"""Make action models from episodes: ONNX files with cards, tested on episodes of their own, then fitted to all."""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Column, Table

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least
from tailor.tools.cli.terminal import table_console
from tailor.tools.learning.training_request import command_of, data_sets, spaces_of

DURATIONS = "bag, robust, distilled, linear, m5, boosting, network"  # named here to spare --help the libraries
SUCCESSES = "taught, forest, distilled, tree, boosting, network, svm"
RARE = 0.02  # a smaller share of failures is too few to learn from

EPILOG = """\
examples:
  tailor train agilo --data data/agilo
  tailor train agilo --data data/agilo --learner m5 --features relative --zoo out/zoo
  tailor train powercube

A data set is what `tailor gather` writes to DATA/ACTION. Each action gets a duration model, an energy model when its
episodes tell what the drives worked, and a success model when some of them failed. Three quarters train, one quarter
tests; the model that is kept is fitted to all."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("robot", help="whose actions, as in the data sets' manifests")
    parser.add_argument("actions", nargs="*", metavar="ACTION", help="which actions (default: all data sets)")
    parser.add_argument("--data", type=Path, nargs="+", help="folders with a data set per action (default: data/ROBOT)")
    parser.add_argument("--zoo", type=Path, default=ZOO, help="folder to write models to (default: the one that ships)")
    parser.add_argument("--features", help="feature space (default: projective, or the one of the data's arguments)")
    parser.add_argument("--energy-features", help="the same for energy (default: joints-relative instead of joints)")
    parser.add_argument("--learner", default="bag", help=f"of durations: {DURATIONS} (default: %(default)s)")
    parser.add_argument("--failure-learner", default="taught", help=f"of successes: {SUCCESSES} (default: %(default)s)")
    seed = at_least(0, "--seed")
    parser.add_argument(
        "--seed", type=seed, default=1, help="draws folds and resampled episodes (default: %(default)s)"
    )
    parser.add_argument("--json", action="store_true", help="print the tests as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Train; exit code 0."""
    _check_names(arguments)
    console, rows, sets = Console(stderr=True), [], data_sets(arguments)
    (arguments.zoo / arguments.robot).mkdir(parents=True, exist_ok=True)  # whether it can be, before hours of learning
    for action, folders in sets.items():
        with console.status(f"learning {action}"):
            rows.extend(train_one(folders, arguments))
    _withdraw(arguments, console)
    if arguments.json:
        print(json.dumps(rows))
    else:
        table_console().print(_table(rows))
    return 0


def _check_names(arguments: argparse.Namespace) -> None:
    """Whether there are such learners and features; told before hours of learning, not after them."""
    from tailor.models.features.features import SPACES
    from tailor.models.training import learners

    learners.make_learner("duration", arguments.learner, arguments.seed)
    learners.make_learner("success", arguments.failure_learner, arguments.seed)
    for name in (arguments.features, arguments.energy_features):
        if name is not None and name not in SPACES:
            raise UsageError(f"no feature space '{name}' (expected one of: {', '.join(SPACES)})")


def _withdraw(arguments: argparse.Namespace, console: Console) -> None:
    """A refinement gate judges the choices of the models that it was learned with: these are gone now."""
    from tailor.models.export.gate_publishing import remove_gate

    if remove_gate(arguments.zoo, arguments.robot):
        again = f"tailor train-gate {arguments.robot}"
        console.print(
            f"removed {arguments.robot}/refinement/benefit, learned with the models before; `{again}` makes it"
        )


def train_one(folders: list[Path], arguments: argparse.Namespace) -> list[dict[str, Any]]:
    """Train the models of one action and write them to the zoo; returns what they reached in the test."""
    from tailor.models import runtime
    from tailor.models.episodes.episodes import UNOBSERVED, merge, read_data_set
    from tailor.models.episodes.regression_targets import ENERGY
    from tailor.models.export import publishing
    from tailor.models.training import training

    sets = [read_data_set(folder) for folder in folders]
    data = merge(sets)
    if data.manifest["robot"] != arguments.robot:
        raise UsageError(f"{folders[0]}: episodes of robot '{data.manifest['robot']}', expected '{arguments.robot}'")
    spaces = spaces_of(arguments, data.names, folders[0])
    manifests = {folder: each.manifest for folder, each in zip(folders, sets, strict=True)}
    command = command_of(arguments, spaces, manifests)
    jobs = [("duration", arguments.learner, training.train_duration)]
    if sum(ENERGY.told(episode) and episode.finished for episode in data.episodes) >= training.LEAST:
        jobs.append(("energy", arguments.learner, partial(training.train_regression, ENERGY)))
    failures = sum(episode.failure not in ("", UNOBSERVED) for episode in data.episodes)
    if failures >= RARE * len(data.episodes):
        jobs.append(("success", arguments.failure_learner, training.train_success))
    rows = []
    for kind, learner, train in jobs:
        try:
            trained = train(data.episodes, spaces[kind], learner, arguments.seed)
        except UsageError as error:
            raise UsageError(f"{', '.join(map(str, folders))}: {error}") from None
        about = publishing.Publication(kind, learner, spaces[kind], arguments.seed, command)
        path = publishing.publish(arguments.zoo, data, trained, about)
        runtime.load_model(path)  # a model that does not pass its own check must not ship
        rows.append({"robot": arguments.robot, "action": data.manifest["action"], "kind": kind, **trained.test})
    return rows


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
        name = f"{row['robot']}/{row['action']}/{row['kind']}"
        if row["kind"] == "success":
            shares = f"{row['accuracy_pct']:.1f} %", f"{row['missed_failures_pct']:.1f} %"
            table.add_row(name, str(row["n"]), "", "", *shares)
            continue
        unit, mean = ("s", "mean_duration_s") if row["kind"] == "duration" else ("J", "mean_energy_j")
        low, high = row["mae_ci95"]
        error = f"{row[f'mae_{unit.lower()}']:.3f} {unit} ({low:.3f} .. {high:.3f})"
        table.add_row(name, str(row["n"]), f"{row[mean]:.2f} {unit}", error, "", "")
    return table
