"""Chooses the folder that trained models are written to; never one of an installed package."""

from __future__ import annotations

import os
from pathlib import Path

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import package_models_folder, robot_names, user_models_folder


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
