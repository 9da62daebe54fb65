"""A new robot's package as `tailor new robot` writes it, known to this process without an installation."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from tailor.schemas import codec, typesystem
from tailor.schemas.own import converters
from tailor.schemas.packages import discovery
from tailor.schemas.ros2 import action, profiles, service
from tailor.schemas.topics import TOPICS, key_of
from tailor.tools.new_robot.names import package_of
from tailor.tools.new_robot.templates import write_robot


@contextmanager
def known_robot(name: str, kind: str, into: Path) -> Iterator[Path]:
    """The folder of a new robot; commands in this process know it meanwhile."""
    with known_package(name, package_of(name), write_robot(name, kind, into)) as folder:
        yield folder


@contextmanager
def known_package(domain: str, package: str, folder: Path) -> Iterator[Path]:
    """A folder with the package of a robot; commands in this process know its domain meanwhile."""
    point, declared = EntryPoint(domain, f"{package}:SPEC", discovery.GROUP), discovery._declared
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(str(folder))
            patch.setattr(discovery, "_declared", lambda: iter([*declared(), point]))
            _forget()
            yield folder
    finally:
        _forget()
        for module in [each for each in sys.modules if each.split(".")[0] == package]:
            del sys.modules[module]


def _forget() -> None:
    """Read packages, topics and message types anew."""
    TOPICS.__dict__.pop("_read", None)
    for cached in (
        discovery.packages,
        typesystem.message_types,
        typesystem.own_types,
        typesystem.typestore,
        typesystem._types_by_name,
        typesystem.definition,
        typesystem.type_hash,
        typesystem.hash_of,
        codec._codec,
        codec._limit,
        converters,
        service.set_goal_hash,
        action.achieve_goal,
        key_of,
        profiles.topic_at,
        profiles._in_table,
    ):
        cached.cache_clear()
