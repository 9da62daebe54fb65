"""Episodes of a data set that a model predicts: what its rules are compared on, and its pictures are drawn from."""

from __future__ import annotations

from pathlib import Path

from tailor.models.cards.card import Card
from tailor.models.episodes.context_columns import beside_context, without_context
from tailor.models.episodes.episodes import Episode, read_data_set
from tailor.models.episodes.manifest import MANIFEST
from tailor.schemas.errors import UsageError

BESIDE_OBJECTS = "clearance"  # kind of models whose arguments are followed by those of an object


def folder_of(card: Card, data: Path | None) -> Path:
    """Folder of the data set of a model's action; `data` is as for `known_episodes`."""
    folder: Path = (data or Path("data") / card["robot"]) / card["action"]
    return folder


def known_episodes(card: Card, data: Path | None) -> tuple[Episode, ...]:
    """Episodes with the arguments of a model; none if there is no data set, or one beside objects for other models.

    Args:
      card: Of the model.
      data: Folder with a data set per action; None looks in data/ROBOT.

    Raises:
      UsageError: The data set cannot be read, or is of another robot, action or arguments.
    """
    folder = folder_of(card, data)
    if not (folder / MANIFEST).exists():
        return ()
    found = read_data_set(folder)
    for key in ("robot", "action"):
        if found.manifest[key] != card[key]:
            raise UsageError(f"{folder}: episodes of {key} '{found.manifest[key]}', expected '{card[key]}'")
    if card["kind"] == BESIDE_OBJECTS:
        fitting = beside_context(found)
    else:  # of several objects noted after a run, each has an episode: the run would count as often
        fitting = None if found.manifest.get("objects") else without_context(found)
    if fitting is None:
        return ()
    wanted = tuple(argument["name"] for argument in card["arguments"])
    if fitting.names != wanted:
        raise UsageError(f"{folder}: arguments are {' '.join(fitting.names)}, expected {' '.join(wanted)} by the model")
    return fitting.episodes
