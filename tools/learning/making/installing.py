"""Checks that all models of a robot were made, and puts them in the place of the old ones."""

from __future__ import annotations

from pathlib import Path

from tailor.executive import domains
from tailor.models.cards.card import card_path
from tailor.models.cards.model_files import read_model
from tailor.models.export.zoo_writer import replace_model
from tailor.schemas.errors import UsageError
from tailor.tools.learning.making.making import Making


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
    models = sorted((made / robot).glob("*/*.onnx"))
    for model in models:
        replace_model(zoo / model.relative_to(made), *read_model(model))
    kept = {path.relative_to(made) for model in models for path in (model, card_path(model))}
    for path in [*(zoo / robot).glob("*/*.onnx"), *(zoo / robot).glob("*/*.card.json")]:
        if path.relative_to(zoo) not in kept:
            path.unlink()  # of an action or kind that has no model any more
