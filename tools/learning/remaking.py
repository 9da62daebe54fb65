"""States how stale models are made anew: by a recipe, by gathering and training, or from recordings."""

from __future__ import annotations

from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.tools.learning.model_folders import target_zoo
from tailor.tools.learning.recipe_file import recipe_path


def remaking_advice(robot: str, zoo: Path | None) -> str:
    """Commands that make the models of a robot anew.

    Args:
      robot: Name of the robot.
      zoo: Folder of models that the user named; None if none was named.

    Raises:
      UsageError: There is no such robot.
    """
    into = _zoo_flag(robot, zoo)
    if not spec_of_robot(robot).body:
        return f"`tailor gather {robot} --from RECORDING` and `tailor train {robot}{into}`"
    if recipe_path(robot).is_file():
        return f"`tailor make-models {robot}{into}`"
    by_recipe = f"`tailor make-models {robot} --recipe FILE{into}`"
    return f"`tailor gather {robot}` and `tailor train {robot}{into}`, or by a recipe: {by_recipe}"


def _zoo_flag(robot: str, zoo: Path | None) -> str:
    """The flag that names the folder of models; empty if the commands find it themselves."""
    if zoo is not None:
        return f" --zoo {zoo}"
    try:
        target_zoo(None, robot)
    except UsageError:
        return " --zoo DIR"
    return ""
