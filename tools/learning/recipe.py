"""Recipes: how the models of a robot are made from seeds, declared in `recipe.toml` beside them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.settings import from_table

RECIPE = "recipe.toml"


@dataclass(frozen=True, slots=True)
class Round:
    """Episodes that the models trained so far choose.

    Attributes:
      source: "on-policy": runs of the executive; "active": its choices on which the models disagree most.
      scenarios: Scenarios that are run, or from which situations are drawn.
      episodes: Runs of each scenario; of an active round episodes of each action.
      pool: Of an active round: situations that are drawn for each episode.
    """

    source: Literal["on-policy", "active"]
    scenarios: tuple[str, ...]
    episodes: int
    pool: int = 4


@dataclass(frozen=True, slots=True)
class RandomEpisodes:
    """Number of random episodes of an action that needs another one than most."""

    action: str
    episodes: int


@dataclass(frozen=True, slots=True)
class Training:
    """Options of `tailor train`, and kinds of models; empty: its defaults, all kinds."""

    kinds: tuple[Literal["duration", "success", "clearance", "energy"], ...] = ()
    features: str = ""
    energy_features: str = ""
    learner: str = ""
    failure_learner: str = ""
    clearance_learner: str = ""
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Recipe:
    """How the models of a robot are made.

    Attributes:
      episodes: Random episodes of each action,
      random: but for these.
      beside: Random runs beside objects, of each action that has a model of success beside an object.
      objects: Objects noted after each of these runs, an episode each (see `object_gathering.py`); 0: one that is
        there while it runs.
      seed: Of all random draws of gathering.
      rounds: Rounds that follow, each with the models trained on all episodes before it.
      training: How each model is trained.
      profile: Of the body; empty: the usual one.
    """

    episodes: int
    beside: int = 0
    objects: int = 0
    seed: int = 7
    random: tuple[RandomEpisodes, ...] = ()
    rounds: tuple[Round, ...] = ()
    training: Training = field(default_factory=Training)
    profile: str = ""

    def episodes_of(self, action: str) -> int:
        """Number of random episodes of an action."""
        return next((each.episodes for each in self.random if each.action == action), self.episodes)


def recipe_path(robot: str) -> Path:
    """Path of the recipe of a robot's package.

    Raises:
      UsageError: There is no such robot.
    """
    return models_folder(robot) / robot / RECIPE


def read_recipe(path: Path) -> Recipe:
    """Read a recipe.

    Raises:
      UsageError: The file is missing, not TOML, or an entry is unknown, of a wrong type or not positive.
    """
    try:
        table = tomllib.loads(path.read_text())
    except OSError:
        raise UsageError(
            f"{path}: no recipe, expected one with at least `episodes = NUMBER` (docs/learning.md)"
        ) from None
    except tomllib.TOMLDecodeError as error:
        raise UsageError(f"{path}: not a recipe ({error}), expected TOML") from None
    if "episodes" not in table:
        raise UsageError(f"{path}: lacks `episodes`, the number of random episodes of each action")
    recipe = from_table(Recipe, table, str(path))
    chosen = (number for each in recipe.rounds for number in (each.episodes, each.pool))
    for count in (recipe.episodes, *(each.episodes for each in recipe.random), *chosen):
        if count < 1:
            raise UsageError(f"{path}: a number of episodes is {count}, expected at least 1")
    return recipe
