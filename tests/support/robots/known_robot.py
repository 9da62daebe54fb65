"""A new robot's package as `tailor new robot` writes it, known to this process without an installation."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from tailor.schemas.packages import discovery
from tailor.tools.new_robot.names import package_of
from tailor.tools.new_robot.templates import write_robot


@contextmanager
def known_robot(name: str, kind: str, into: Path) -> Iterator[Path]:
    """The folder of a new robot; commands in this process know it meanwhile."""
    folder, package = write_robot(name, kind, into), package_of(name)
    point, declared = EntryPoint(name, f"{package}:SPEC", discovery.GROUP), discovery._declared
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(str(folder))
            patch.setattr(discovery, "_declared", lambda: iter([*declared(), point]))
            discovery.packages.cache_clear()
            yield folder
    finally:
        discovery.packages.cache_clear()
        for module in [each for each in sys.modules if each.split(".")[0] == package]:
            del sys.modules[module]
