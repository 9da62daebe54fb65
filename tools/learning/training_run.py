"""Trains the action models of a robot, tests them on held-out episodes, and publishes them in a zoo."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from tailor.executive import domains
from tailor.models.cards.card import KINDS
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.tools.learning.training_request import (
    TrainingRequest,
    check_owner,
    check_units,
    check_whole,
    context_space,
    data_sets,
    reproduction_command,
    spaces_by_kind,
)

if TYPE_CHECKING:
    from tailor.models.episodes.episodes import DataSet, Episode
    from tailor.models.features.features import FeatureSpace
    from tailor.models.training.training import Trained

    Train = Callable[[Sequence[Episode], FeatureSpace, str, int], Trained]
    Job = tuple[DataSet, str, str, Train, FeatureSpace]  # episodes, kind, learner

MIN_FAILURE_SHARE = 0.02  # of the episodes: fewer failures are too few to learn from
MIN_APART = 100  # finished ones, beside objects and without: fewer do not determine intervals of their own
NEVER_FAILED = "constant"  # the learner for an action that never failed, but names a model of success


def train_models(
    request: TrainingRequest, on_action: Callable[[str, int, int], None] = lambda *_: None
) -> list[dict[str, Any]]:
    """Train the models of every requested action and write them to the zoo.

    Errors in the request are raised before the first model is trained.

    Args:
      request: What to train.
      on_action: Called before the models of each action are trained, with its name, its number and the number of all.

    Returns:
      One row per model: robot, action, kind and test results.

    Raises:
      UsageError: An unknown learner or feature space, one of the robot's that cannot be exported, missing or
        unsuitable data, or a zoo that cannot be written.
    """
    request, sets = checked(request), data_sets(request)
    for folder in itertools.chain(*sets.values()):
        check_owner(folder, request.robot)
        check_whole(folder)
    _check_own_spaces(request.robot)
    (request.zoo / request.robot).mkdir(parents=True, exist_ok=True)  # fails before hours of training, not after
    rows: list[dict[str, Any]] = []
    for folders in sets.values() if len(sets) > 1 else ():  # a fault of a later one's would be found after the first
        _read(folders, request)
    for number, (action, folders) in enumerate(sets.items()):
        on_action(action, number, len(sets))
        rows.extend(train_action(folders, request))
    return rows


def checked(request: TrainingRequest) -> TrainingRequest:
    """The request with the current names of its learners.

    Raises:
      UsageError: There is no such learner or feature space.
    """
    from tailor.models.features.spaces import feature_space
    from tailor.models.training.learners import learner_name

    for name in (request.features, request.energy_features):
        if name is not None:
            feature_space(name)
    return replace(
        request,
        learner=learner_name("duration", request.learner),
        failure_learner=learner_name("success", request.failure_learner),
        clearance_learner=learner_name("success", request.clearance_learner),
    )


def _check_own_spaces(robot: str) -> None:
    """Raise UsageError if a space of the robot's package cannot be exported: a whole training would end in that."""
    from tailor.models.export.space_check import faults_of_spaces

    spec = spec_of_robot(robot) if robot in robot_names() else None
    if spec is not None and (faults := list(faults_of_spaces(spec))):
        raise UsageError(f"domain {spec.name}: features = '{spec.features}': {'; '.join(faults)}")


def train_action(folders: Sequence[Path], request: TrainingRequest) -> Iterator[dict[str, Any]]:
    """Train the models of one action; yields a row of test results per published model.

    Raises:
      UsageError: The episodes cannot be read, are of another robot, or are too few.
    """
    jobs, command = _read(folders, request)
    kinds = [kind for _, kind, *_ in jobs]
    for source, kind, learner, train, space in (job for job in jobs if not request.kinds or job[1] in request.kinds):
        with _named(folders):
            trained = train(source.episodes, space, learner, request.seed)
        _publish(request, source, trained, kind, learner, space, command)
        action = source.manifest["action"]
        if kind == "duration" and "duration_beside" not in kinds:
            _remove_beside(request, action)
        yield {"robot": request.robot, "action": action, "kind": kind, **trained.test}


def _read(folders: Sequence[Path], request: TrainingRequest) -> tuple[list[Job], str]:
    """The models that the episodes of one action suffice for, and the command that reproduces them.

    Raises:
      UsageError: The episodes cannot be read or do not mix, their arguments do not fit the feature spaces, or fewer
        finished than a model of durations takes.
    """
    from tailor.models.episodes.context_columns import without_context
    from tailor.models.episodes.episodes import merge, read_data_set
    from tailor.models.training.training import check_count

    sets = [read_data_set(folder) for folder in folders]
    alone = [each for each in sets if not each.manifest.get("objects")]  # a run counts once, not once for every object
    with _named(folders):
        data = merge(own := [without_context(each) for each in alone or sets])
    spaces = spaces_by_kind(request, data.names, folders[0])
    with _named(folders):
        _check_columns(spaces.values(), own, data)
        jobs = [(data, kind, learner, train, spaces[kind]) for kind, learner, train in own_jobs(data, request)]
        if jobs and "duration" in (request.kinds or KINDS):
            check_count(_learned(data), "finished")
    manifests = {folder: each.manifest for folder, each in zip(folders, sets, strict=True)}
    return [*jobs, *context_jobs(sets, request, folders[0])], reproduction_command(request, spaces, manifests)


@contextmanager
def _named(folders: Sequence[Path]) -> Iterator[None]:
    """Errors name the data sets whose episodes are trained on."""
    try:
        yield
    except UsageError as error:
        raise UsageError(f"{', '.join(map(str, folders))}: {error}") from None


def _check_columns(spaces: Iterable[FeatureSpace], sets: Sequence[DataSet], data: DataSet) -> None:
    """Raise UsageError if a column has or seems to have another unit than features take, or one is not finite."""
    from tailor.models.episodes.plausible import implausible
    from tailor.models.export.space_check import fault_in_data

    if fault := next(filter(None, map(implausible, sets)), ""):
        raise UsageError(fault)
    for space in {space.name: space for space in spaces}.values():
        for each in sets:
            check_units(space, each.manifest["arguments"])
        if fault := fault_in_data(space, data.episodes):
            raise UsageError(fault)


def _remove_beside(request: TrainingRequest, action: str) -> None:
    """Remove the model of durations beside objects that was learned before: its mean is that of other episodes."""
    for path in (request.zoo / request.robot / action).glob("duration_beside.*"):
        path.unlink()


def context_jobs(sets: Sequence[DataSet], request: TrainingRequest, folder: Path) -> Iterator[Job]:
    """The model of success beside one object, if the episodes have objects."""
    from tailor.models.episodes.context_columns import beside_context, run_numbers
    from tailor.models.episodes.episodes import merge

    beside = [each for each in map(beside_context, sets) if each is not None]
    if beside:
        data = merge(beside)
        train = partial(_beside_objects, run_numbers(beside))
        yield data, "clearance", request.clearance_learner, train, context_space(data.names, folder)


def _needs_success(robot: str, data: DataSet) -> bool:
    """Whether the action of the episodes names a model of success, without which the executive refuses to start."""
    if robot not in robot_names():
        return False
    actions = domains.load(spec_of_robot(robot).name).actions.values()
    return f"{data.manifest['action']}/success" in {action.success_model for action in actions}


def own_jobs(data: DataSet, request: TrainingRequest) -> Iterator[tuple[str, str, Train]]:
    """Kind, learner and training function of each model that the episodes suffice for."""
    from tailor.models.episodes.episodes import UNOBSERVED
    from tailor.models.episodes.regression_targets import ENERGY
    from tailor.models.training import success_training, training

    if data.manifest.get("objects"):
        return
    learned = _learned(data)
    beside = [episode.in_context for episode in learned]
    if min(beside.count(True), beside.count(False)) >= MIN_APART:
        yield "duration", request.learner, training.train_duration_alone
        yield "duration_beside", request.learner, training.train_duration_beside
    else:
        yield "duration", request.learner, training.train_duration
    with_energy = sum(map(ENERGY.is_recorded, learned))
    if with_energy >= training.MIN_EPISODES:
        yield "energy", request.learner, partial(training.train_regression, ENERGY)
    failures = sum(episode.failure not in ("", UNOBSERVED) for episode in data.episodes)
    if data.episodes and all(episode.failure == UNOBSERVED for episode in data.episodes):
        return
    if failures >= MIN_FAILURE_SHARE * len(data.episodes) or (failures and _needs_success(request.robot, data)):
        yield "success", request.failure_learner, success_training.train_success
    elif _needs_success(request.robot, data):
        yield "success", NEVER_FAILED, success_training.train_success


def _learned(data: DataSet) -> list[Episode]:
    """Episodes that durations and energies are learned from."""
    return [episode for episode in data.episodes if episode.finished and not episode.calibrates]


def _beside_objects(
    runs: Sequence[int], episodes: Sequence[Episode], space: FeatureSpace, learner: str, seed: int
) -> Trained:
    """Train success beside objects; the episodes of one run have its number, and are never split."""
    from tailor.models.training import success_training

    numbered = [replace(each, number=run) for each, run in zip(episodes, runs, strict=True)]
    return success_training.train_success(numbered, space, learner, seed)


def _publish(
    request: TrainingRequest,
    data: DataSet,
    trained: Trained,
    kind: str,
    learner: str,
    space: FeatureSpace,
    command: str,
) -> None:
    """Publish a model in the zoo, unless it fails its own checks: the former one stays there."""
    from tailor.models.cards.model_files import read_model
    from tailor.models.export.publishing import Publication, publish
    from tailor.models.export.zoo_writer import replace_model
    from tailor.models.runtime import load_model

    written = request.zoo / request.robot / data.manifest["action"] / f"{kind}.onnx"
    with TemporaryDirectory() as apart:
        try:
            made = publish(Path(apart), data, trained, Publication(kind, learner, space, request.seed, command))
            load_model(made)
            replace_model(written, *read_model(made))
        except UsageError as error:
            named = str(error).replace(apart, str(request.zoo))
            raise UsageError(f"{named}; such a model is not written, what was there stays") from None
        except OSError as error:  # that of a full disk names no file
            raise UsageError(f"{written} or its card: {error.strerror}, expected files that can be written") from error
