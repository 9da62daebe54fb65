"""Renders the templates of a kind of robot into a folder.

A template is a text file `FILE.template` in which `${name}` and `${package}` stand for the robot's names; a folder
`package` becomes the Python package.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from string import Template

from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_folders import temporary_beside
from tailor.tools.new_robot.names import check_name, package_of

SUFFIX = ".template"
COMMON = "common"  # folder of the files that all kinds share
PACKAGE = "package"


def kinds() -> list[str]:
    """Kinds of robots for which there are templates."""
    return sorted(each.name for each in _folder().iterdir() if each.is_dir() and each.name != COMMON)


def write_robot(name: str, kind: str, into: Path) -> Path:
    """Write the package of a new robot, all of it or nothing.

    Args:
      name: Name of robot, domain and distribution.
      kind: One of `kinds()`.
      into: Existing folder, in which the new one is made.

    Returns:
      The new folder, `into/name`.

    Raises:
      UsageError: The name cannot be used, `into` is no folder, or the new folder exists or cannot be written.
    """
    check_name(name)
    folder = into / name
    if not into.is_dir():
        raise UsageError(f"--into is {into}, expected an existing folder")
    if os.path.lexists(folder):
        raise UsageError(f"{folder} exists already, expected another NAME or --into DIR: nothing is overwritten")
    with temporary_beside(folder) as unfinished:
        for path, text in rendered(name, kind).items():
            (unfinished / path).parent.mkdir(parents=True, exist_ok=True)
            (unfinished / path).write_text(text, encoding="utf-8")
        unfinished.rename(folder)
    return folder


def rendered(name: str, kind: str) -> dict[str, str]:
    """Contents of the new package's files by path."""
    package = package_of(name)
    files: dict[str, str] = {}
    for part in (COMMON, kind):
        for path, template in _templates(_folder() / part):
            parts = [package if each == PACKAGE else each for each in path.split("/")]
            files["/".join(parts).removesuffix(SUFFIX)] = Template(template).substitute(name=name, package=package)
    return files


def _templates(folder: Traversable, inside: str = "") -> Iterator[tuple[str, str]]:
    """Path inside the folder, and text, of each template."""
    for each in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if each.is_dir():
            yield from _templates(each, f"{inside}{each.name}/")
        elif each.name.endswith(SUFFIX):
            yield f"{inside}{each.name}", each.read_text(encoding="utf-8")


def _folder() -> Traversable:
    return resources.files(__package__) / "templates"
