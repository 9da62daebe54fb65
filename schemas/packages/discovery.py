"""Finds the packages of robots: the entry points of the group `tailor.domains`. Their parts are not loaded.

A package that cannot be used is kept with its faults. It hinders only those who name it: no broken package may keep
another robot from running, or an e-stop from its driver.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import tailor
from tailor.schemas.packages.spec import DomainSpec, faults_of

if TYPE_CHECKING:  # takes 20 ms, for which no e-stop waits
    from importlib.metadata import EntryPoint

GROUP = "tailor.domains"
OURS = "tailor"


@dataclass(frozen=True, slots=True)
class Package:
    """A package as found: its entry point, and its spec or what is wrong with it.

    Attributes:
      name: Name of the entry point.
      declared_in: `module:attribute` of the spec.
      spec: None if there is none.
      faults: Each names the field.
    """

    name: str
    declared_in: str
    spec: DomainSpec | None
    faults: tuple[str, ...]


@cache
def packages() -> tuple[Package, ...]:
    """All installed packages, ours first, each in alphabetical order; read once a process."""
    return read_packages(_declared())


def read_packages(declared: Iterable[EntryPoint]) -> tuple[Package, ...]:
    """The packages of entry points. One whose name or robot another one has already is at fault; never one of ours."""
    read: list[Package] = []
    for point in sorted(set(declared), key=lambda point: (not _is_ours(point), point.name, point.value)):
        package = _read(point)
        read.append(replace(package, faults=(*package.faults, *_taken(package, read))))
    return tuple(read)


def _is_ours(point: EntryPoint) -> bool:
    return point.value.startswith(f"{OURS}.")


def _read(point: EntryPoint) -> Package:
    try:
        spec = point.load()
    except (Exception, SystemExit) as error:  # a script of a user may end itself where something is missing
        return Package(point.name, point.value, None, (f"cannot be loaded: {type(error).__name__}: {error}",))
    if not isinstance(spec, DomainSpec):
        return Package(point.name, point.value, None, (f"is a {type(spec).__name__}, expected a DomainSpec",))
    faults = faults_of(spec)
    if spec.name != point.name:
        faults = (f"name is '{spec.name}', expected '{point.name}' as its entry point", *faults)
    module = import_module(point.module)
    home = module.__name__ if hasattr(module, "__path__") else module.__name__.rpartition(".")[0]
    return Package(point.name, point.value, replace(spec, package=spec.package or home), faults)


def _taken(package: Package, earlier: Sequence[Package]) -> Iterator[str]:
    for other in earlier:
        if other.name == package.name:
            yield f"name is '{package.name}', which {other.declared_in} has already"
        elif package.spec and other.spec and other.spec.robot == package.spec.robot:
            yield f"robot is '{package.spec.robot}', which {other.declared_in} has already"


def _declared() -> Iterator[EntryPoint]:
    """Entry points of all distributions; of our own source tree from its pyproject.toml.

    An editable install copies the entry points when it is made: after a `git pull` they may be old.
    """
    from importlib.metadata import entry_points

    own = _of_source_tree(Path(tailor.__file__).parents[2] / "pyproject.toml")
    for point in entry_points(group=GROUP):
        if not own or point.dist is None or point.dist.name != OURS:
            yield point
    yield from own


def _of_source_tree(file: Path) -> tuple[EntryPoint, ...]:
    """Entry points of our source tree; none if this is no source tree."""
    from importlib.metadata import EntryPoint

    if not file.is_file():
        return ()
    project = tomllib.loads(file.read_text(encoding="utf-8")).get("project", {})
    if project.get("name") != OURS:
        return ()
    return tuple(EntryPoint(name, value, GROUP) for name, value in project["entry-points"][GROUP].items())
