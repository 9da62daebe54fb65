"""Folders of models: those that hold the models of a name, and the one into which a robot's are written."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder, package_models_folder, robot_names, user_models_folder
from tailor.schemas.packages.discovery import packages


def located(named: Sequence[str], zoo: Path | None) -> dict[Path, list[str]]:
    """Full names of models, "robot/action/kind", by the folder that holds them.

    Args:
      named: What a user named, models, actions and robots; none: the models of all robots.
      zoo: The folder, if the user named one; None: each robot has its own.

    Raises:
      UsageError: There are none, or none of a robot that is named.
    """
    if not named:
        return {zoo: _models_in(zoo)} if zoo is not None else _of_all_robots()
    found: dict[Path, list[str]] = {}
    for name in named:
        folder = zoo or _folder_of(name)
        found.setdefault(folder, []).extend(_full(name, folder))
    return found


def _of_all_robots() -> dict[Path, list[str]]:
    """Models that ship, and of each other robot those in its own folder, if it has any."""
    found = {ZOO: _models_in(ZOO)}
    for robot in robot_names():
        with suppress(UsageError):  # a package at fault hinders only those who name it, one without models nobody
            folder = models_folder(robot)
            mine = [] if folder == ZOO else [each for each in _models_in(folder) if each.startswith(f"{robot}/")]
            if mine:
                found.setdefault(folder, []).extend(mine)
    return found


def _folder_of(name: str) -> Path:
    """Folder of the models of a named robot; that of those that ship if none is known by that name."""
    robot = name.partition("/")[0]
    declared = (*robot_names(), *(package.name for package in packages()))  # at fault, too: that is reported then
    return models_folder(robot) if robot in declared else ZOO


def _full(name: str, zoo: Path) -> list[str]:
    """Full names of the models that a name stands for: a robot for all its models, an action for its duration."""
    if "/" in name:
        return [name if name.count("/") != 1 else f"{name}/duration"]
    mine = [each for each in _models_in(zoo) if each.startswith(f"{name}/")]
    if not mine:
        robots = ", ".join(_robots(_models_in(zoo)))
        raise UsageError(f"'{name}' has no models in {zoo} (expected ROBOT/ACTION/KIND, or one of: {robots})")
    return mine


def _models_in(zoo: Path) -> list[str]:
    files = (path for end in ("card.json", "onnx") for path in zoo.glob(f"*/*/*.{end}"))
    named = (path for path in files if not path.name.startswith("."))  # others are copies of macOS, say
    names = sorted({"/".join((*path.parts[-3:-1], path.name.split(".")[0])) for path in named})
    if not names:
        raise UsageError(f"{zoo}: no action models, expected ROBOT/ACTION/duration.onnx (`tailor train` writes them)")
    return names


def _robots(names: Iterable[str]) -> list[str]:
    return sorted({name.partition("/")[0] for name in names})


def target_zoo(zoo: Path | None, robot: str, own: Path | None = None) -> Path:
    """Folder to write models to.

    Args:
      zoo: The folder that the user named, None if none was named.
      robot: Name of the robot.
      own: Folder of the models of the robot's package, the default in an editable checkout; None: as its spec declares.

    Returns:
      `zoo` if named; otherwise `own`, if it lies in a checkout and is writable; otherwise the user's data folder.

    Raises:
      UsageError: `zoo` is a file; or no folder is named, and `own` is part of an installation with models of the
        robot, which come before those of the user.
    """
    if zoo is not None:
        if zoo.exists() and not zoo.is_dir():
            raise UsageError(f"--zoo {zoo} is a file, expected a folder")
        return zoo
    own = own or (package_models_folder(robot) if robot in robot_names() else ZOO)
    if _is_in_checkout(own) and os.access(own if own.exists() else own.parent, os.W_OK):
        return own
    if (own / robot).is_dir():
        raise UsageError(f"models are not written into the installed package ({own}), expected --zoo DIR")
    return user_models_folder()


def _is_in_checkout(folder: Path) -> bool:
    """Whether a folder of models lies in a source tree: no folder above an installed package has this file."""
    return any((root / "pyproject.toml").is_file() for root in folder.parents[:3])
