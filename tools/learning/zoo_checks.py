"""Checks of the models in a zoo: damaged, of another place, unfit for their robot, missing, stale."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from tailor.executive import domains
from tailor.executive.robot_models import check_fit
from tailor.models.cards.card import Card
from tailor.models.runtime import BESIDE, load_model
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder, robot_names, spec_of_robot
from tailor.tools.learning.staleness import staleness


def checked(found: Sequence[str], named: Sequence[str], zoo: Path) -> Iterator[tuple[str, str, str]]:
    """Check models, and whether any is missing.

    Args:
      found: Names of models in the zoo, "robot/action/kind".
      named: What the user named, robots and models; none: all.
      zoo: Their folder.

    Yields:
      Name of a model, what is wrong with it, and else how it is stale; both may be empty.
    """
    for name in [*found, *_missing(named, zoo)]:
        try:
            card, (robot, _, path) = load_model(name, zoo).card, name.partition("/")
            check_fit(robot, path, card, zoo / name)
            _check_beside(name, card, zoo)
            yield name, "", staleness(card)
        except UsageError as error:
            yield name, str(error), ""


def _missing(named: Sequence[str], zoo: Path) -> list[str]:
    """Models that an action of the named robots needs to start, of all whose folder this is if none is named."""
    theirs = [robot for robot in robot_names() if models_folder(robot) == zoo or (zoo / robot).is_dir()]
    missing = []
    for robot in (robot for robot in theirs if robot in named or not named):
        actions = domains.load(spec_of_robot(robot).name).actions.values()
        needed = [path for action in actions for path in (action.duration_model, action.success_model) if path]
        missing += [f"{robot}/{path}" for path in needed if not [*(zoo / robot).glob(f"{path}.*")]]
    return [*dict.fromkeys(missing)]


def _check_beside(name: str, card: Card, zoo: Path) -> None:
    """Raise UsageError if durations beside objects are of other episodes than those without; nothing loads such."""
    if not name.endswith(BESIDE):
        return
    own = load_model(name.removesuffix(BESIDE), zoo).card
    if own["episodes"].get("sha256") != card["episodes"].get("sha256"):
        other = name.removesuffix(BESIDE)
        raise UsageError(f"{zoo / name}.onnx: learned from other episodes than {other}, expected the same")
