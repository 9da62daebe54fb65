"""Reads recipes from `recipe.toml` beside a robot's models, and checks their numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.parsed_files import read_toml
from tailor.schemas.settings import from_table
from tailor.tools.learning.gathering.situations import MAX_SITUATIONS, too_many
from tailor.tools.learning.recipe import MAX_SEED, Recipe

RECIPE = "recipe.toml"


def recipe_path(robot: str) -> Path:
    """Path of the recipe of a robot's package.

    Raises:
      UsageError: There is no such robot.
    """
    return models_folder(robot) / robot / RECIPE


def recipe_of(robot: str) -> Recipe:
    """Recipe of a robot's package.

    Raises:
      UsageError: There is no such robot, its package has no recipe, or see `read_recipe`.
    """
    path = recipe_path(robot)
    if not path.is_file():
        raise UsageError(
            f"robot {robot} has no recipe by which its models could be made anew, expected a file {path} with at least "
            "`episodes = NUMBER` (docs/learning.md)"
        )
    return read_recipe(path)


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
    rounds = table.get("rounds", ())
    if any("pool" in each and each["source"] != "active" for each in rounds):
        yield "rounds.pool: only active rounds draw several situations for each episode"
    if any("horizon" in each and each["source"] != "on-policy" for each in rounds):
        yield "rounds.horizon: only on-policy rounds execute what is chosen with it"


def _counts(recipe: Recipe) -> Iterator[tuple[str, int, int]]:
    """Key of each number in the file, its value, and the least legal one."""
    yield from (("episodes", recipe.episodes, 1), ("beside", recipe.beside, 0), ("objects", recipe.objects, 0))
    yield from (("random.episodes", each.episodes, 1) for each in recipe.random)
    yield from ((f"{name}.episodes", drawn.episodes, 1) for name, drawn in recipe.chosen)
    for each in recipe.uncertain:
        yield from (("uncertain.episodes", each.episodes, 1), ("uncertain.pool", each.pool, 1))
    for chosen in recipe.rounds:
        yield from (("rounds.pool", chosen.pool, 1), ("rounds.horizon", chosen.horizon, 1))


def _repeated(name: str, words: Sequence[str]) -> Iterator[str]:
    yield from (
        f"{name}: '{word}' is there twice, expected once" for word in sorted({w for w in words if words.count(w) > 1})
    )
