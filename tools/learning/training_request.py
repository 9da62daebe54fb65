"""What `tailor train` is to learn from: data sets, feature spaces, and the command that makes the models again."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    from tailor.models.features.features import FeatureSpace

DEFAULT_FEATURES = "projective"
ENERGY_FEATURES = {"joints": "joints-relative"}  # gravity's work depends on where the joints are, durations do not


def _space(name: str | None, arguments: tuple[str, ...], folder: Path) -> FeatureSpace:
    """The feature space of that name, or the one that is meant for an action's arguments.

    Raises:
      UsageError: It is of other arguments.
    """
    from tailor.models.features.features import SPACES

    fitting = [each for each, space in SPACES.items() if tuple(q.name for q in space.arguments) == arguments]
    wanted = name or (DEFAULT_FEATURES if DEFAULT_FEATURES in fitting else next(iter(fitting), DEFAULT_FEATURES))
    if wanted not in fitting:
        takes = " ".join(quantity.name for quantity in SPACES[wanted].arguments)
        raise UsageError(f"{folder}: arguments are {' '.join(arguments)}, expected {takes} by features '{wanted}'")
    return SPACES[wanted]


def spaces_of(arguments: argparse.Namespace, names: tuple[str, ...], folder: Path) -> dict[str, FeatureSpace]:
    """The feature space of each kind of model, by kind.

    Raises:
      UsageError: One is of other arguments than the data.
    """
    plain = _space(arguments.features, names, folder)
    energy = arguments.energy_features or ENERGY_FEATURES.get(plain.name, plain.name)
    return {"duration": plain, "energy": _space(energy, names, folder), "success": plain}


def data_sets(arguments: argparse.Namespace) -> dict[str, list[Path]]:
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


def command_of(
    arguments: argparse.Namespace, spaces: Mapping[str, FeatureSpace], manifests: Mapping[Path, Mapping[str, Any]]
) -> str:
    """The commands that make the models again, in their order; on-policy runs took the models of those before."""
    robot, action = arguments.robot, next(iter(manifests.values()))["action"]
    data = "" if not arguments.data else " --data " + " ".join(map(str, arguments.data))
    train = f"tailor train {robot} {action}{data} --features {spaces['duration'].name}"
    if spaces["energy"] is not spaces["duration"]:
        train += f" --energy-features {spaces['energy'].name}"
    train += f" --learner {arguments.learner} --failure-learner {arguments.failure_learner} --seed {arguments.seed}"
    gathering = [f"{_gathering(robot, manifest)} --out {path.parent}" for path, manifest in manifests.items()]
    return " && ".join([*gathering, train])


def _gathering(robot: str, manifest: Mapping[str, Any]) -> str:
    """The command that made a data set."""
    if "recordings" in manifest:
        return f"tailor gather {robot} --from {' '.join(manifest['recordings'])}"
    scenarios = manifest.get("scenarios")
    what = manifest["action"] if scenarios is None else f"--on-policy {' '.join(scenarios)}"
    return f"tailor gather {robot} {what} --episodes {manifest.get('episodes')} --seed {manifest.get('seed')}"
