"""A robot's action models: loaded, and checked to fit its actions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.action import unchanged
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.sequence import InstantiatedAction
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage_models import models_of
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder, spec_of_robot

PLACE_UNIT = "m"
COVER_TOLERANCE = 1e-6  # of the bounds of a range, for rounded decimals


def load_models(robot: str, zoo: str = "") -> Models:
    """Load a robot's action models.

    Raises:
      UsageError: A missing or altered model, one whose training range is smaller than its action's, or one that takes
        other arguments.
    """
    from tailor.models.runtime import load_robot  # and onnxruntime: a simulator or launcher has no use for 30 MB of it

    folder = Path(zoo) if zoo else models_folder(robot)
    durations, successes = load_robot(robot, folder)
    loaded: dict[str, Any] = {**durations, **successes}
    for path, model in loaded.items():
        check_fit(robot, path, model.card, folder / robot / path)
    return Models(durations, successes)


def check_fit(robot: str, path: str, card: Mapping[str, Any], place: Path) -> None:
    """Check that a model was trained on the ranges of its robot's actions, and takes their parameters in their order.

    Args:
      robot: Its robot.
      path: "action/kind".
      card: Its card.
      place: Where it lies, for errors.

    Raises:
      UsageError: It covers less, or takes others; the arguments of energies and of success beside an object are free.
    """
    check_ranges(card, _required_ranges(robot).get(path.rpartition("/")[0], {}), place)
    taken = [each["name"] for each in card["arguments"]]
    for action in domains.load(spec_of_robot(robot).name).actions.values():
        declared = [parameter.name for parameter in action.parameters]
        reads = path in (action.duration_model, action.success_model) and action.arguments is unchanged
        if reads and declared != taken:
            expected = f"expected {' '.join(declared)} by the action {action.name}"
            raise UsageError(f"{place}: takes {' '.join(taken)}, {expected}")


def check_ranges(card: Mapping[str, Any], declared: Mapping[str, tuple[float, float]], place: Path) -> None:
    """Check that a model was trained on the ranges, by argument, that its action declares.

    Raises:
      UsageError: It was trained on a smaller range, or lacks the argument.
    """
    trained = {argument["name"]: argument for argument in card["arguments"]}
    for name, (lower, upper) in declared.items():
        if name not in trained:
            raise UsageError(f"{place}: the model has no argument '{name}' (its arguments: {', '.join(trained)})")
        low, high = trained[name]["lower"], trained[name]["upper"]
        if lower < low - COVER_TOLERANCE or upper > high + COVER_TOLERANCE:
            raise UsageError(
                f"{place}: {name} was trained in [{low:g}, {high:g}] {trained[name]['unit']}, "
                f"expected to cover [{lower:g}, {upper:g}] as the action declares"
            )


def check_models(context: Context) -> None:
    """Raise UsageError, naming action and model, if an action needs a model that is not loaded.

    A tick would find out while the robot is armed. Which ones are needed depends on the settings, too: energy counts
    only where it has a weight.
    """
    check_all_named(context.domain, context.models, context.settings.refinement)


def check_all_named(domain: Domain, models: Models, settings: RefinementSettings) -> None:
    """As `check_models`, before there is a scenario."""
    missing = []
    for action in domain.actions.values():
        try:
            models_of(InstantiatedAction(action, 0, ()), models, settings)
        except UsageError as error:
            missing.append(str(error))
    if missing:
        raise UsageError("; ".join(missing))


def _required_ranges(robot: str) -> dict[str, dict[str, tuple[float, float]]]:
    """Ranges that a robot's actions declare, by the folder of their models and by parameter.

    Places are left out: models use their distance and direction, which single parameters do not bound.
    """
    ranges: dict[str, dict[str, tuple[float, float]]] = {}
    for action in domains.load(spec_of_robot(robot).name).actions.values():
        declared = ranges.setdefault(action.duration_model.rpartition("/")[0], {})
        for p in (parameter for parameter in action.parameters if parameter.unit != PLACE_UNIT):
            lower, upper = declared.get(p.name, (p.lower, p.upper))
            declared[p.name] = min(lower, p.lower), max(upper, p.upper)
    return ranges
