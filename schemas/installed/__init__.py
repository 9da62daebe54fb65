"""Looks up the installed packages of robots, and loads single parts of them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from importlib import import_module, resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.packages.discovery import Package, packages
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.topics import TOPICS


def domain_names() -> tuple[str, ...]:
    """Names of the domains that can be used, in alphabetical order."""
    return tuple(package.name for package in packages() if package.spec and not _faults(package))


def robot_names() -> tuple[str, ...]:
    """Names of the robots that can be used, in the order of `domain_names`."""
    return tuple(package.spec.robot for package in packages() if package.spec and not _faults(package))


def spec_of(name: str) -> DomainSpec:
    """Spec of a domain.

    Raises:
      UsageError: There is none, or its package is at fault; the message lists the known names, or all faults.
    """
    named = [package for package in packages() if package.name == name]
    return _usable(named, f"no domain {name!r}, expected one of: {', '.join(domain_names())}{_meant(name)}")


def spec_of_robot(robot: str) -> DomainSpec:
    """Spec of the domain of a robot.

    Raises:
      UsageError: As `spec_of`.
    """
    owners = [package for package in packages() if package.spec and package.spec.robot == robot]
    unread = [package for package in packages() if package.spec is None]  # the robot's package may be one of them
    none = f"no robot {robot!r}, expected one of: {', '.join(robot_names())}{_meant(robot)}"
    return _usable(
        owners or [package for package in unread if package.name == robot], "; ".join([none, *map(_refusal, unread)])
    )


def _usable(found: Iterable[Package], otherwise: str) -> DomainSpec:
    """The spec of the one among `found` that is not at fault."""
    faulty = []
    for package in found:
        faults = _faults(package)
        if package.spec and not faults:
            return package.spec
        faulty.append(_refusal(package))
    raise UsageError("; ".join(faulty) or otherwise)


def _meant(name: str) -> str:
    """Which robot is of which domain, where the one was named for the other."""
    specs = [package.spec for package in packages() if package.spec and not _faults(package)]
    meant = [f" ({each.robot} is the robot of {each.name})" for each in specs if name in (each.name, each.robot)]
    return "".join(meant)


def _refusal(package: Package) -> str:
    return f"{package.declared_in}: {'; '.join(_faults(package))}"


def _faults(package: Package) -> tuple[str, ...]:
    return (*package.faults, *TOPICS.faults.get(package.name, ()))


def part(spec: DomainSpec, field: str) -> Any:
    """Import an object that a spec names.

    Args:
      spec: Spec of a domain.
      field: Name of the attribute that names the object, e.g. "body".

    Raises:
      UsageError: The spec names none, or what it names cannot be imported.
    """
    written: str = getattr(spec, field)
    if not written:
        raise UsageError(f"domain {spec.name} has no {field}: its spec names none")
    module, _, attribute = written.partition(":")
    try:
        loaded = import_module(module)
        return getattr(loaded, attribute) if attribute else loaded
    except (ImportError, AttributeError, SyntaxError) as error:
        raise UsageError(f"domain {spec.name}: {field} = '{written}': {error}") from error
    except (Exception, SystemExit) as error:  # code of a package, which hinders only those who name it
        raise UsageError(f"domain {spec.name}: {field} = '{written}': {raised_text(error)}") from error


def instance(spec: DomainSpec, field: str) -> Any:
    """What an object that a spec names returns when it is called without arguments, e.g. the domain of "domain".

    Raises:
      UsageError: As `part`; or the package's code raises an error, or returns nothing.
    """
    make = part(spec, field)
    where = f"domain {spec.name}: {field} = '{getattr(spec, field)}'"
    try:
        made = make()
    except UsageError:
        raise
    except (Exception, SystemExit) as error:
        raise UsageError(f"{where}: {raised_text(error)}") from error
    if made is None:
        raise UsageError(f"{where}: returned None, expected an object: a `return` is missing")
    return made


def file(spec: DomainSpec, field: str) -> Traversable:
    """A file or folder that a spec names; it may be missing.

    Raises:
      UsageError: Its package cannot be imported.
    """
    written: str = getattr(spec, field)
    package, _, path = written.rpartition(":")
    if not (package or spec.package):
        raise UsageError(
            f"domain {spec.name}: {field} = '{written}': its spec lies in a module of no package, expected PACKAGE:PATH"
        )
    try:
        return resources.files(package or spec.package).joinpath(path)
    except ImportError as error:
        raise UsageError(f"domain {spec.name}: {field} = '{written}': {error}") from error


def models_folder(robot: str) -> Path:
    """Folder of a robot's models: its package's own, else the user's, if it has models of that robot.

    Raises:
      UsageError: There is no such robot.
    """
    own, users = package_models_folder(robot), user_models_folder()
    return users if (users / robot).is_dir() and not (own / robot).is_dir() else own


def package_models_folder(robot: str) -> Path:
    """Folder of the models that a robot's package ships; it may be missing.

    Raises:
      UsageError: There is no such robot.
    """
    return Path(str(file(spec_of_robot(robot), "models"))).resolve()


def user_models_folder() -> Path:
    """The user's own models, where `tailor train` writes those of an installed package that ships none.

    It lies in the data folder of the XDG Base Directory Specification, which ignores a path that is not absolute.
    """
    base = Path(os.environ.get("XDG_DATA_HOME", ""))
    return (base if base.is_absolute() else Path.home() / ".local" / "share") / "tailor" / "models"
