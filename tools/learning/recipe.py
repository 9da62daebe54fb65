"""Recipes: how the models of a robot are made from seeds, declared in `recipe.toml` beside them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.parsed_files import read_toml
from tailor.schemas.settings import from_table
from tailor.tools.learning.gathering.situations import MAX_SITUATIONS, too_many

RECIPE = "recipe.toml"
UNCERTAIN_POOL = 30  # tasks drawn for each episode of uncertain success
MAX_SEED = 1_000_000_000  # a learner of several networks multiplies it, and scikit-learn takes 32 bits


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

    @property
    def situations(self) -> int:
        """Number of situations in which models choose."""
        return self.episodes * (self.pool if self.source == "active" else len(self.scenarios))


@dataclass(frozen=True, slots=True)
class Calibration:
    """Runs with the models of all other episodes, to correct their intervals; only successes are learned from them.

    Attributes:
      scenarios: Scenarios that are run.
      episodes: Runs of each scenario.
    """

    scenarios: tuple[str, ...]
    episodes: int

    @property
    def situations(self) -> int:
        """Number of runs."""
        return self.episodes * len(self.scenarios)


@dataclass(frozen=True, slots=True)
class RandomEpisodes:
    """Number of random episodes of an action that needs another one than most."""

    action: str
    episodes: int


@dataclass(frozen=True, slots=True)
class UncertainEpisodes:
    """Random episodes whose success the models of the random ones are least certain of.

    Attributes:
      action: An action with a model of success.
      episodes: Their number.
      pool: Tasks that are drawn for each of them.
    """

    action: str
    episodes: int
    pool: int = UNCERTAIN_POOL


@dataclass(frozen=True, slots=True)
class OwnLearner:
    """Learner of the durations and energies of an action that needs another one than most."""

    action: str
    learner: str


@dataclass(frozen=True, slots=True)
class Training:
    """Options of `tailor train`, kinds of models, and learners of single actions; empty: its defaults, all kinds."""

    kinds: tuple[Literal["duration", "success", "clearance", "energy", "duration_beside"], ...] = ()
    features: str = ""
    energy_features: str = ""
    learner: str = ""
    failure_learner: str = ""
    clearance_learner: str = ""
    learners: tuple[OwnLearner, ...] = ()
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Recipe:
    """How the models of a robot are made.

    Attributes:
      episodes: Random episodes of each action,
      random: but for these.
      beside: Random runs beside objects, of each action that has a model of success beside an object.
      objects: Objects noted after each of these runs, an episode each (see `beside_objects.py`); 0: one that is
        there while it runs.
      uncertain: Episodes that follow, of actions that seldom fail.
      seed: Of all random draws of gathering.
      rounds: Rounds that follow, each with the models trained on all episodes before it.
      calibration: Runs after all rounds.
      training: How each model is trained.
      profile: Of the body; empty: the usual one.
    """

    episodes: int
    beside: int = 0
    objects: int = 0
    seed: int = 7
    random: tuple[RandomEpisodes, ...] = ()
    uncertain: tuple[UncertainEpisodes, ...] = ()
    rounds: tuple[Round, ...] = ()
    calibration: tuple[Calibration, ...] = ()
    training: Training = field(default_factory=Training)
    profile: str = ""

    def episodes_of(self, action: str) -> int:
        """Number of random episodes of an action."""
        return next((each.episodes for each in self.random if each.action == action), self.episodes)

    @property
    def chosen(self) -> list[tuple[str, Round | Calibration]]:
        """All that models choose, each with its name in the file."""
        return [*(("rounds", each) for each in self.rounds), *(("calibration", each) for each in self.calibration)]


def recipe_path(robot: str) -> Path:
    """Path of the recipe of a robot's package.

    Raises:
      UsageError: There is no such robot.
    """
    return models_folder(robot) / robot / RECIPE


def read_recipe(path: Path) -> Recipe:
    """Read a recipe.

    Raises:
      UsageError: The file is missing, not TOML, or an entry is unknown, of a wrong type or out of range.
    """
    table = read_toml(path, "a recipe with at least `episodes = NUMBER` (docs/learning.md)")
    if "episodes" not in table:
        raise UsageError(f"{path}: lacks `episodes`, the number of random episodes of each action")
    recipe = from_table(Recipe, table, str(path))
    faults = [*_faults(recipe), *_without_effect(table)]
    if faults:
        raise UsageError(f"{path}: {'; '.join(faults)}")
    return recipe


def _faults(recipe: Recipe) -> Iterator[str]:
    """Values that are out of range, all of them."""
    for name, seed in (("seed", recipe.seed), ("training.seed", recipe.training.seed)):
        if not 0 <= seed <= MAX_SEED:
            yield f"{name} is {seed}, expected 0 to {MAX_SEED}"
    yield from (
        f"{name} is {count}, expected at least {least}" for name, count, least in _counts(recipe) if count < least
    )
    if recipe.objects > 0 and not recipe.beside:
        yield f"objects is {recipe.objects}, expected none without `beside`, the number of runs beside them"
    yield from _repeated("random", [each.action for each in recipe.random])
    yield from _repeated("uncertain", [each.action for each in recipe.uncertain])
    yield from _repeated("training.learners", [each.action for each in recipe.training.learners])
    for name, chosen in recipe.chosen:
        if not chosen.scenarios:
            yield f"{name}.scenarios is empty, expected at least one"
        yield from _repeated(f"{name}.scenarios", chosen.scenarios)
        if chosen.situations > MAX_SITUATIONS:
            yield f"{name}: {too_many(chosen.situations)}"


def _without_effect(table: dict[str, Any]) -> Iterator[str]:
    """Entries that nothing heeds; the recipe itself no longer distinguishes them from defaults."""
    if any("pool" in each and each["source"] != "active" for each in table.get("rounds", ())):
        yield "rounds.pool: only active rounds draw several situations for each episode"


def _counts(recipe: Recipe) -> Iterator[tuple[str, int, int]]:
    """Key of each number in the file, its value, and the least legal one."""
    yield from (("episodes", recipe.episodes, 1), ("beside", recipe.beside, 0), ("objects", recipe.objects, 0))
    yield from (("random.episodes", each.episodes, 1) for each in recipe.random)
    yield from ((f"{name}.episodes", chosen.episodes, 1) for name, chosen in recipe.chosen)
    for each in recipe.uncertain:
        yield from (("uncertain.episodes", each.episodes, 1), ("uncertain.pool", each.pool, 1))
    yield from (("rounds.pool", each.pool, 1) for each in recipe.rounds)


def _repeated(name: str, words: Sequence[str]) -> Iterator[str]:
    yield from (
        f"{name}: '{word}' is there twice, expected once" for word in sorted({w for w in words if words.count(w) > 1})
    )
