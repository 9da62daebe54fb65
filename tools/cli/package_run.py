"""Ends a process in order when code of a robot's package raises in the midst of a run."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from types import TracebackType

from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import OBJECTS, DomainSpec
from tailor.tools.cli.plain_text import plain


@contextmanager
def blamed_on_running_package(spec: DomainSpec) -> Iterator[None]:
    """Raise what comes out of a package's code as a UsageError: a restart of the process would not correct it.

    Its traceback, from where it enters the package on, is printed first, for those who write the package. What did not
    come through that code stays as it is, as does all of a package that ships.
    """
    try:
        yield
    except UsageError:
        raise
    except (Exception, SystemExit) as error:
        folders = _folders(spec)
        passed = _entered(error.__traceback__, folders)
        if passed is None:
            raise
        for line in "".join(traceback.format_exception(type(error), error, passed)).splitlines():
            print(plain(line), file=sys.stderr)
        last = [line for line in traceback.extract_tb(passed) if _within(line.filename, folders)][-1]
        text = f"{type(error).__name__}: {' '.join(str(error).split())}"
        place = f"{last.name}, {last.filename}, line {last.lineno}"
        raise UsageError(f"the package of {spec.name} raised {text} (in {place}); the robot is stopped") from error


def _entered(at: TracebackType | None, folders: set[Path]) -> TracebackType | None:
    """The traceback from the first line in one of the folders on; None if there is none."""
    while at is not None and not _within(at.tb_frame.f_code.co_filename, folders):
        at = at.tb_next
    return at


def _within(filename: str, folders: set[Path]) -> bool:
    return any(Path(filename).is_relative_to(folder) for folder in folders)


def _folders(spec: DomainSpec) -> set[Path]:
    """Folders, or single files, of the packages that do not ship and hold parts of a robot."""
    named = {spec.package, *(getattr(spec, field) for field in OBJECTS)}
    roots = {name.partition(":")[0].partition(".")[0] for name in named} - {"", "tailor"}
    found = [each for each in map(find_spec, roots) if each is not None]
    return {Path(place) for each in found for place in each.submodule_search_locations or filter(None, [each.origin])}
