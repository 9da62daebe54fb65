"""Make action models from episodes: ONNX files with cards, tested on episodes of their own, then fitted to all."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from models.runtime import ZOO
from schemas.errors import UsageError

RARE = 0.02  # a smaller share of failures is too few to learn from

EPILOG = """\
examples:
  tailor train agilo --data data/agilo
  tailor train agilo --data data/agilo --learner m5 --features relative --zoo out/zoo

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
    parser.add_argument("--features", default="projective", help="feature space (default: %(default)s)")
    parser.add_argument("--learner", default="bag", help="of durations: bag, linear, m5 (default: %(default)s)")
    parser.add_argument("--failure-learner", default="forest", help="of successes: forest, tree (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="draws folds and resampled episodes (default: %(default)s)")
    parser.add_argument("--json", action="store_true", help="print the tests as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Train; exit code 0."""
    console = Console(stderr=True)
    rows = []
    for action, folders in _data_sets(arguments).items():
        with console.status(f"learning {action}"):
            rows.extend(train_one(folders, arguments))
    _withdraw(arguments, console)
    if arguments.json:
        print(json.dumps(rows))
    else:
        Console().print(_table(rows))
    return 0


def _withdraw(arguments: argparse.Namespace, console: Console) -> None:
    """A benefit tree judges the choices of the models that it was learned with: these are gone now."""
    from models.benefit_publishing import withdraw_benefit

    if withdraw_benefit(arguments.zoo, arguments.robot):
        again = f"tailor train-benefit {arguments.robot}"
        console.print(
            f"removed {arguments.robot}/refinement/benefit, learned with the models before; `{again}` makes it"
        )


def train_one(folders: list[Path], arguments: argparse.Namespace) -> list[dict[str, Any]]:
    """Train the models of one action and write them to the zoo; returns what they reached in the test."""
    from models import publishing, runtime, training
    from models.amounts import ENERGY
    from models.episodes import UNOBSERVED, merge, read_data_set
    from models.features import SPACES

    if arguments.features not in SPACES:
        raise UsageError(f"no feature space '{arguments.features}' (expected one of: {', '.join(SPACES)})")
    sets = [read_data_set(folder) for folder in folders]
    data, space = merge(sets), SPACES[arguments.features]
    command = _command(arguments, {folder: each.manifest for folder, each in zip(folders, sets, strict=True)})
    if data.manifest["robot"] != arguments.robot:
        raise UsageError(f"{folders[0]}: episodes of robot '{data.manifest['robot']}', expected '{arguments.robot}'")
    if data.names != tuple(quantity.name for quantity in space.arguments):
        raise UsageError(f"{folders[0]}: arguments {data.names}, expected {space.arguments} by features '{space.name}'")
    jobs = [("duration", arguments.learner, training.train_duration)]
    if sum(ENERGY.told(episode) and episode.finished for episode in data.episodes) >= training.LEAST:
        jobs.append(("energy", arguments.learner, partial(training.train_amount, ENERGY)))
    failures = sum(episode.failure not in ("", UNOBSERVED) for episode in data.episodes)
    if failures >= RARE * len(data.episodes):
        jobs.append(("success", arguments.failure_learner, training.train_success))
    rows = []
    for kind, learner, train in jobs:
        trained = train(data.episodes, space, learner, arguments.seed)
        about = publishing.Publication(kind, learner, space, arguments.seed, command)
        path = publishing.publish(arguments.zoo, data, trained, about)
        runtime.load_model(path)  # a model that does not pass its own check must not ship
        rows.append({"robot": arguments.robot, "action": data.manifest["action"], "kind": kind, **trained.test})
    return rows


def _data_sets(arguments: argparse.Namespace) -> dict[str, list[Path]]:
    """Folders of each action's episodes, by action."""
    roots = arguments.data or [Path("data") / arguments.robot]
    found: dict[str, list[Path]] = {}
    for path in (path for root in roots for path in sorted(root.glob("*/manifest.json"))):
        found.setdefault(path.parent.name, []).append(path.parent)
    said = ", ".join(map(str, roots))
    for action in arguments.actions:
        if action not in found:
            raise UsageError(f"{said}: no episodes of '{action}' (data sets there: {', '.join(found) or 'none'})")
    if not found:
        raise UsageError(f"{said}: no data sets, expected ACTION/manifest.json (`tailor gather` makes them)")
    return {action: found[action] for action in arguments.actions or found}


def _command(arguments: argparse.Namespace, manifests: Mapping[Path, Mapping[str, Any]]) -> str:
    """The commands that make the model again, in their order; on-policy runs took the models of those before."""
    robot, action = arguments.robot, next(iter(manifests.values()))["action"]
    data = "" if not arguments.data else " --data " + " ".join(map(str, arguments.data))
    train = f"tailor train {robot} {action}{data} --features {arguments.features} --learner {arguments.learner}"
    train += f" --failure-learner {arguments.failure_learner} --seed {arguments.seed}"
    gathering = [f"{_gathering(robot, manifest)} --out {path.parent}" for path, manifest in manifests.items()]
    return " && ".join([*gathering, train])


def _gathering(robot: str, manifest: Mapping[str, Any]) -> str:
    """The command that made a data set."""
    if "recordings" in manifest:
        return f"tailor gather {robot} --from {' '.join(manifest['recordings'])}"
    scenarios = manifest.get("scenarios")
    what = manifest["action"] if scenarios is None else f"--on-policy {' '.join(scenarios)}"
    return f"tailor gather {robot} {what} --episodes {manifest.get('episodes')} --seed {manifest.get('seed')}"


def _table(rows: list[dict[str, Any]]) -> Table:
    table = Table("model", "test episodes", "mean", "test MAE (95 % interval)", "accuracy", "missed failures")
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
