"""Makes the models of a robot from seeds: random episodes, then rounds that the models trained so far choose.

Equal source, libraries, recipe and platform give equal models, bit for bit. Every step is resumed where it stopped.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.models.cards.card import KINDS
from tailor.models.episodes.manifest import MANIFEST
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.source import episodes_sha256, learning_sha256, runs_sha256
from tailor.tools.learning.gathering import data_set_spec, policy_runs, random_episodes, run_data_sets
from tailor.tools.learning.gathering.active_episodes import Active, run_active
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.recipe import Recipe, Round
from tailor.tools.learning.recipe_checks import check_recipe
from tailor.tools.learning.training_request import (
    DEFAULT_CLEARANCE_LEARNER,
    DEFAULT_FAILURE_LEARNER,
    DEFAULT_LEARNER,
    TrainingRequest,
    data_sets,
    feature_spaces,
)
from tailor.tools.learning.training_run import checked, train_models
from tailor.tools.parallel.pool import Processes
from tailor.tools.parallel.steps import Step, counted

WHOLE = "whole"  # marker of a folder of models, written last
CHOOSING = (
    "duration",
    "duration_beside",
    "success",
    "clearance",
)  # kinds of models that choices depend on, while energies have no price


@dataclass(frozen=True, slots=True)
class Making:
    """Models to make.

    Attributes:
      robot: Name of the robot.
      recipe: How its models are made.
      work: Folder of the episodes and models of all steps.
      jobs: Processes.
      command: Command that makes the same models again, for their cards.
      kinds: Kinds of models to make; empty: the recipe's. Those that only choose further episodes are of `CHOOSING`
        kinds.
    """

    robot: str
    recipe: Recipe
    work: Path
    jobs: int
    command: str
    kinds: tuple[str, ...] = ()

    @property
    def domain(self) -> str:
        """Name of the robot's domain."""
        return random_episodes.domain_of(self.robot)

    @property
    def random(self) -> Path:
        """Folder of the random episodes; other controllers, bodies, profiles or seeds have another one."""
        profile = f"-{self.recipe.profile}" if self.recipe.profile else ""
        return self.work / self.robot / f"random-{episodes_sha256(self.domain)[:12]}-{self.recipe.seed}{profile}"

    @property
    def beside(self) -> Path:
        """Folder of the random episodes beside one object."""
        return self.random.with_name(f"{self.random.name}-beside")

    @property
    def rounds(self) -> Path:
        """Folder of all that depends on learners and refinement, too."""
        about = [runs_sha256(self.domain), episodes_sha256(self.domain), learning_sha256()]
        key = json.dumps([*about, dataclasses.asdict(self.recipe), self.kinds])
        return self.work / self.robot / hashlib.sha256(key.encode()).hexdigest()[:12]

    @property
    def zoo(self) -> Path:
        """Folder of the finished models."""
        return self.rounds / "zoo"

    def chooser(self, number: int) -> Path:
        """Folder of the models that choose the episodes of round `number`, from 0."""
        return self.rounds / f"zoo-{number}"

    @property
    def data(self) -> list[Path]:
        """Folders with the data sets of the random episodes, and of each round."""
        return [self.random, *(self.rounds / f"round-{k + 1}" for k in range(len(self.recipe.rounds)))]


def check(making: Making) -> None:
    """Check all names in the recipe, before anything is gathered.

    Raises:
      UsageError: An unknown scenario, action, profile, learner or feature space, or one that does not fit the actions.
    """
    check_recipe(making.robot, making.recipe)
    request, domain = checked(_request(making, making.zoo, (), ())), domains.load(making.domain)
    for action in run_data_sets.modelled_actions(making.domain):
        feature_spaces(request, tuple(data_set_spec.argument_names(domain, action)), Path(action))


def make(making: Making) -> Iterator[Step]:
    """Gather and train all that is missing; yields progress. The models are in `making.zoo` at the end.

    Raises:
      UsageError: See `check`; or too few episodes, or a model that an action names and that could not be learned.
    """
    check(making)
    yield from _random_episodes(making)
    for number, each in enumerate(making.recipe.rounds):
        zoo = making.chooser(number)
        yield from _trained(making, zoo, making.data[: number + 1], CHOOSING)
        yield from _round(making, number, each, zoo)
    yield from _trained(making, making.zoo, making.data, making.kinds or making.recipe.training.kinds)
    check_complete(making)


def check_complete(making: Making) -> None:
    """Check that the zoo has every model of durations and successes that the robot's actions name.

    Raises:
      UsageError: One is missing: there were too few episodes, say.
    """
    for action in domains.load(making.domain).actions.values():
        for name in filter(None, (action.duration_model, action.success_model)):
            if not (making.zoo / making.robot / f"{name}.onnx").exists():
                count = making.recipe.episodes_of(action.name)
                raise UsageError(f"{action.name} needs {name}, which {count} random episodes do not suffice to learn")


def install(made: Path, zoo: Path, robot: str) -> None:
    """Replace a robot's models in a zoo by those just made; its recipe and other robots' models stay."""
    shutil.copytree(made / robot, zoo / robot, dirs_exist_ok=True)
    kept = {path.relative_to(made) for path in (made / robot).rglob("*")}
    for path in [*(zoo / robot).glob("*/*.onnx"), *(zoo / robot).glob("*/*.card.json")]:
        if path.relative_to(zoo) not in kept:
            path.unlink()  # of an action or kind that has no model any more


def _random_sets(making: Making) -> list[tuple[str, int, Path, bool]]:
    """Data sets of random episodes: action, number, folder, and whether each is beside an object."""
    recipe, declared = making.recipe, domains.load(making.domain).actions
    actions = run_data_sets.modelled_actions(making.domain)
    wanted = [(action, recipe.episodes_of(action), making.random, False) for action in actions]
    if recipe.beside:
        contexts = {action: declared[action].context for action in actions}
        near = [
            action for action, context in contexts.items() if context and context.success_model.startswith(f"{action}/")
        ]
        wanted += [(action, recipe.beside, making.beside, True) for action in near]
    return wanted


def _random_episodes(making: Making) -> Iterator[Step]:
    recipe = making.recipe
    for action, count, folder, beside in _random_sets(making):
        objects = recipe.objects if beside else 0
        drawn = (making.domain, action, count, recipe.seed, folder / action)
        spec = DataSetSpec(*drawn, beside=beside, objects=objects, profile=recipe.profile)
        random_episodes.prepare(spec, resume=True)
        missing = random_episodes.missing_parts(spec)
        left = sum(min(random_episodes.PART, count - first) for first in missing)
        running = (done for done, *_ in random_episodes.gather(spec, missing, making.jobs))
        title = f"{action}: random episodes" + (" beside an object" if beside else "")
        yield from counted(title, running, count, count - left)


def _round(making: Making, number: int, each: Round, zoo: Path) -> Iterator[Step]:
    seed, title = making.recipe.seed + number, f"round {number + 1}"
    where = (seed, str(zoo), making.data[number + 1], making.recipe.profile)
    if each.source == "active":
        active = Active(making.domain, each.scenarios, each.episodes, each.pool, *where)
        for step in run_active(active, making.jobs):
            yield Step(f"{title}: {step.title}", step.done, step.total)
        return
    policy = policy_runs.Policy(making.domain, each.scenarios, each.episodes, *where)
    running = policy_runs.run_policy(policy, making.jobs)
    yield from counted(f"{title}: runs of {', '.join(each.scenarios)}", running, len(policy.jobs))


def _trained(making: Making, zoo: Path, data: list[Path], kinds: tuple[str, ...]) -> Iterator[Step]:
    """Train as `tailor train` does, unless that has been done."""
    title = f"training {zoo.name}"
    if not (zoo / WHOLE).exists():
        yield Step(title, 0, 1)
        near = [making.beside] if making.recipe.beside else []
        present = tuple(folder for folder in (*data, *near) if any(folder.glob(f"*/{MANIFEST}")))
        if not present:
            raise UsageError(f"{making.work}: no episodes to train on")
        _train(_request(making, zoo, present, kinds), making.jobs)
        (zoo / WHOLE).touch()
    yield Step(title, 1, 1)


def _train(request: TrainingRequest, jobs: int) -> None:
    """Train each model in a process of its own: equal bits for any number of jobs."""
    each = [
        dataclasses.replace(request, actions=(action,), kinds=(kind,))
        for kind in request.kinds or KINDS
        for action in data_sets(request)
    ]
    for _ in Processes().completed(train_models, [(one,) for one in each], jobs):
        pass


def _request(making: Making, zoo: Path, data: tuple[Path, ...], kinds: tuple[str, ...]) -> TrainingRequest:
    options = making.recipe.training
    named: dict[str, Any] = {
        "features": options.features or None,
        "energy_features": options.energy_features or None,
        "learner": options.learner or DEFAULT_LEARNER,
        "failure_learner": options.failure_learner or DEFAULT_FAILURE_LEARNER,
        "clearance_learner": options.clearance_learner or DEFAULT_CLEARANCE_LEARNER,
    }
    return TrainingRequest(
        making.robot, zoo, data=data, seed=options.seed, command=making.command, kinds=kinds, **named
    )
