"""Inputs of a training run: data sets, feature spaces, and the command that reproduces the models."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tailor.models.episodes.manifest import MANIFEST, read_manifest
from tailor.models.episodes.sources import CANDIDATES
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering.manifests import unfinished

if TYPE_CHECKING:
    from tailor.models.features.features import FeatureSpace

DEFAULT_LEARNER = "best"
DEFAULT_FAILURE_LEARNER = "distilled-forest"
# Beside objects success turns to failure within the belief's error: held-out log loss 0.151, of the forest 0.213
DEFAULT_CLEARANCE_LEARNER = "networks"
DEFAULT_FEATURES = "projective"
# gravity's work depends on where the joints are, durations do not
ENERGY_FEATURES = {"joints": "joints-relative", "joints-friction": "joints-relative-friction"}


@dataclass(frozen=True, slots=True)
class TrainingRequest:
    """One call of `tailor train`.

    Attributes:
      robot: Name of the robot, as in the data sets' manifests.
      zoo: Folder to write models to.
      actions: Actions to train; empty for all that have a data set.
      data: Folders with a data set per action; empty for data/ROBOT.
      features: Feature space of durations and failures; None for the default of the data's arguments.
      energy_features: Feature space of energies; None for the default of `features`.
      learner: Learner of durations and energies, see `learners.DURATION_LEARNERS`.
      failure_learner: Learner of successes, see `learners.SUCCESS_LEARNERS`.
      clearance_learner: Learner of successes beside an object, of the same table.
      seed: Random seed of folds and resampled episodes.
      kinds: Kinds of models to train; empty: all that the episodes suffice for.
      command: Command that reproduces the models, for their cards; empty: those of gathering and training.
    """

    robot: str
    zoo: Path
    actions: tuple[str, ...] = ()
    data: tuple[Path, ...] = ()
    features: str | None = None
    energy_features: str | None = None
    learner: str = DEFAULT_LEARNER
    failure_learner: str = DEFAULT_FAILURE_LEARNER
    seed: int = 1
    kinds: tuple[str, ...] = ()
    command: str = ""
    clearance_learner: str = DEFAULT_CLEARANCE_LEARNER


def data_sets(request: TrainingRequest) -> dict[str, list[Path]]:
    """Folders of each action's episodes, by action.

    Raises:
      UsageError: There is no data set, none in one of the folders, or none of a requested action.
    """
    roots = request.data or (Path("data") / request.robot,)
    folders: dict[str, list[Path]] = {}
    found = [(root, sorted(root.glob(f"*/{MANIFEST}"))) for root in roots]
    for path in (path for _, paths in found for path in paths):
        folders.setdefault(path.parent.name, []).append(path.parent)
    empty = ", ".join(str(root) for root, paths in found if not paths)
    if empty:
        raise UsageError(f"{empty}: no data sets, expected ACTION/{MANIFEST} (`tailor gather` makes them)")
    searched = ", ".join(map(str, roots))
    for action in request.actions:
        if action not in folders:
            raise UsageError(f"{searched}: no episodes of '{action}' (data sets there: {', '.join(folders) or 'none'})")
    return {action: folders[action] for action in request.actions or folders}


def check_owner(folder: Path, robot: str) -> None:
    """Raise UsageError if a data set is of another robot, or lies in the folder of another action, as copies may.

    The last one that is trained would replace the models of the others.
    """
    manifest = read_manifest(folder)
    if manifest["robot"] != robot:
        raise UsageError(f"{folder}: episodes of robot '{manifest['robot']}', expected '{robot}'")
    if manifest["action"] != folder.name:
        raise UsageError(f"{folder}: episodes of action '{manifest['action']}', expected '{folder.name}' by its name")


def check_whole(folder: Path) -> None:
    """Raise UsageError if gathering of a data set was interrupted: a card names the command that gathers all of it."""
    missing = unfinished(folder, read_manifest(folder))
    if missing:
        go_on = "the same `tailor gather` with --resume gathers them"
        raise UsageError(f"{folder}: gathering was interrupted, {missing} are missing, expected all of them: {go_on}")


def spaces_by_kind(request: TrainingRequest, arguments: tuple[str, ...], folder: Path) -> dict[str, FeatureSpace]:
    """Feature space of each kind of model of the action by itself: "duration", "duration_beside", "energy", "success".

    Args:
      request: Names the spaces, or leaves them to the defaults.
      arguments: Names of the arguments in the data.
      folder: The data set, for errors.

    Raises:
      UsageError: A space takes other arguments than the data has.
    """
    plain = _space(request.features, arguments, folder)
    energy = request.energy_features or ENERGY_FEATURES.get(plain.name, plain.name)
    of_energy = _space(energy, arguments, folder)
    return {"duration": plain, "duration_beside": plain, "energy": of_energy, "success": plain}


def check_units(space: FeatureSpace, arguments: Sequence[Mapping[str, Any]]) -> None:
    """Raise UsageError if a column of a data set, as its manifest declares it, has another unit than features take."""
    for declared, taken in zip(arguments, space.arguments, strict=True):
        unit = declared.get("unit")  # empty: not stated
        if unit and unit != taken.unit:
            raise UsageError(f"{taken.name} is in '{unit}', expected '{taken.unit}' by features '{space.name}'")


def context_space(arguments: tuple[str, ...], folder: Path) -> FeatureSpace:
    """Feature space of success beside one object: the first that takes the arguments and the object's columns.

    Raises:
      UsageError: There is none.
    """
    from tailor.models.features.spaces import feature_spaces

    fitting = (space for space in feature_spaces().values() if tuple(q.name for q in space.arguments) == arguments)
    chosen = next(fitting, None)
    if chosen is None:
        raise UsageError(f"{folder}: no feature space takes the arguments {' '.join(arguments)}")
    return chosen


def _space(name: str | None, arguments: tuple[str, ...], folder: Path) -> FeatureSpace:
    """The feature space of that name, or the default for an action's arguments."""
    from tailor.models.features.spaces import feature_space, feature_spaces

    fitting = [each for each, space in feature_spaces().items() if tuple(q.name for q in space.arguments) == arguments]
    wanted = name or (DEFAULT_FEATURES if DEFAULT_FEATURES in fitting else next(iter(fitting), DEFAULT_FEATURES))
    if wanted not in fitting:
        takes = " ".join(quantity.name for quantity in feature_space(wanted).arguments)
        raise UsageError(f"{folder}: arguments are {' '.join(arguments)}, expected {takes} by features '{wanted}'")
    return feature_space(wanted)


def reproduction_command(
    request: TrainingRequest, spaces: Mapping[str, FeatureSpace], manifests: Mapping[Path, Mapping[str, Any]]
) -> str:
    """The commands that reproduce the models of one action, in order.

    On-policy runs use the models of the commands before them.

    Args:
      request: The training run.
      spaces: See `spaces_by_kind`.
      manifests: Manifest of each data set, by folder.
    """
    if request.command:
        return request.command
    robot, action = request.robot, next(iter(manifests.values()))["action"]
    data = "" if not request.data else " --data " + _words(request.data)
    train = f"tailor train {robot} {action}{data} --features {spaces['duration'].name}"
    if spaces["energy"] is not spaces["duration"]:
        train += f" --energy-features {spaces['energy'].name}"
    train += f" --learner {request.learner} --failure-learner {request.failure_learner}"
    train += f" --clearance-learner {request.clearance_learner} --seed {request.seed}"
    gathering = [
        f"{_gather_command(robot, manifest)} --out {_words([path.parent])}"
        for path, manifest in manifests.items()
        if "recordings" in manifest or manifest.get("seed") is not None  # no command makes what others wrote
    ]
    return " && ".join([*gathering, train])


def _words(names: Iterable[Path | str]) -> str:
    """Names as words of a shell."""
    return " ".join(shlex.quote(str(name)) for name in names)


def _gather_command(robot: str, manifest: Mapping[str, Any]) -> str:
    """The command that gathered a data set."""
    if "recordings" in manifest:
        return f"tailor gather {robot} --from {_words(manifest['recordings'])}"
    number = f"--episodes {manifest.get('episodes')} --seed {manifest.get('seed')}"
    profile = f" --profile {manifest['profile']}" if manifest.get("profile") else ""
    return f"tailor gather {robot} {_drawn(manifest)} {number}{profile}"


def _drawn(manifest: Mapping[str, Any]) -> str:
    """The flags that name what the episodes of a data set were drawn from."""
    scenarios = " ".join(manifest.get("scenarios") or ())
    if manifest.get(CANDIDATES):
        return f"{manifest['action']} --uncertain --pool {_pool(manifest, CANDIDATES)}"
    if manifest.get("situations"):
        return f"--active {scenarios} --pool {_pool(manifest, 'situations')}"
    if scenarios:
        horizon = f" --horizon {manifest['horizon']}" if manifest.get("horizon") else ""
        return f"--on-policy {scenarios}{horizon}" + (" --calibrates" if manifest.get("calibrates") else "")
    action: str = manifest["action"]
    if manifest.get("objects"):
        return f"{action} --beside-objects {manifest['objects']}"
    return f"{action} --beside-object" if (manifest.get("context") or {}).get("names") else action


def _pool(manifest: Mapping[str, Any], drawn: str) -> int:
    """Tasks or situations that were drawn for each episode."""
    return int(manifest[drawn] // max(1, manifest.get("episodes") or 1))
