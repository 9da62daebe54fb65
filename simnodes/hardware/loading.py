"""Loads a Hardware that a person names: `package.module:Class`, or `path/to/file.py:Class`.

A file imports the modules beside it by their names, as one that Python is started with.
"""

from __future__ import annotations

import inspect
import sys
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

from tailor.schemas.errors import UsageError
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.parsed_files import shown
from tailor.simnodes.hardware.interface import Hardware

NUMBERS = ("write_hz", "open_s", "read_s", "write_s")  # of a Hardware
LEAST, MOST = 0.001, 1e6  # of them: beyond, a thread that computes or waits with one ends by an overflow


def load_hardware(named: str) -> Hardware:
    """A new instance of the class that is named.

    Raises:
      UsageError: There is no such class, it is no Hardware, it names no robot, or it needs arguments.
    """
    where, _, name = named.rpartition(":")
    if not where:
        raise UsageError(f"{named}: expected FILE.toml, package.module:Class or FILE.py:Class")
    try:
        found = getattr(_module(where), name)
    except (Exception, SystemExit) as error:  # whatever a person's module does when it is loaded
        raise UsageError(f"{named}: {_cause(error)}, expected package.module:Class or FILE.py:Class") from error
    if not (inspect.isclass(found) and issubclass(found, Hardware)):
        raise UsageError(f"{named}: is no subclass of tailor.simnodes.hardware.interface.Hardware")
    try:
        hardware = found()
        robot, numbers = hardware.robot, {name: getattr(hardware, name) for name in NUMBERS}
    except (Exception, SystemExit) as error:
        raise UsageError(f"{named}: {_cause(error)}, expected a class that is made without arguments") from error
    if not robot:
        raise UsageError(f"{named}: robot is empty, expected the name of the robot")
    for name, value in numbers.items():
        if not (isinstance(value, int | float) and LEAST <= value <= MOST):
            raise UsageError(f"{named}: {name} is {shown(value)}, expected a number from {LEAST:g} to {MOST:g}")
    return hardware


def _cause(error: BaseException) -> str:
    """One line; where an error is from, if it names no cause by itself, such as `division by zero`."""
    text = " ".join(str(error).split())
    if text and isinstance(error, ImportError | AttributeError | OSError | SyntaxError | ValueError):
        return text
    return raised_text(error)


def _module(where: str) -> ModuleType:
    if not where.endswith(".py"):
        return import_module(where)
    path = Path(where)
    spec = spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None or not path.is_file():
        raise OSError(f"no file {path}")
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # for what lies beside it; last, so that no file there takes the place of a library
    module = module_from_spec(spec)
    known = sys.modules.setdefault(path.stem, module)  # where dataclasses look for it, and modules that import it again
    try:
        spec.loader.exec_module(module)
    except BaseException:
        if known is module:
            del sys.modules[path.stem]
        raise
    return module
