"""Errors that code of a robot's package raises, in one line for people."""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import OBJECTS, DomainSpec


@contextmanager
def blamed_on_package(spec: DomainSpec, what: str) -> Iterator[None]:
    """Raise what the code of a package raises as a UsageError that begins with `what`; errors of Tailor's own stay."""
    try:
        yield
    except UsageError:
        raise
    except (Exception, SystemExit) as error:
        if spec.package.startswith("tailor."):
            raise
        raise UsageError(f"{what}: {raised_text(error, spec)}") from error


def raised_text(error: BaseException, spec: DomainSpec | None = None) -> str:
    """What was raised, and the line that raised it: with a spec, the innermost of its package that it came through."""
    lines = _lines(error)
    file, line = next((each for each in reversed(lines) if spec and is_within(each[0], spec)), lines[-1])
    return f"{type(error).__name__}: {' '.join(str(error).split())} ({Path(file).name}, line {line})"


def came_through(error: BaseException, spec: DomainSpec) -> bool:
    """Whether an error was raised in the code of a package, or in what it called."""
    return any(is_within(file, spec) for file, _ in _lines(error))


def is_within(filename: str, spec: DomainSpec) -> bool:
    """Whether a file is one of those of a package that does not ship, or of another that holds a part of its robot."""
    return any(Path(filename).is_relative_to(folder) for folder in _folders(spec))


def _lines(error: BaseException) -> Sequence[tuple[str, int]]:
    """File and number of each line that an error came through, the innermost last."""
    here = [(line.filename, line.lineno or 0) for line in traceback.extract_tb(error.__traceback__)]
    return getattr(error, "raised_at", here)  # of an error from another process, which has its lines as an attribute


def _folders(spec: DomainSpec) -> frozenset[Path]:
    """Folders, or single files."""
    named = {spec.package, *(getattr(spec, field) for field in OBJECTS)}
    roots = {name.partition(":")[0].partition(".")[0] for name in named} - {"", "tailor"}
    found = [each for each in map(find_spec, roots) if each is not None]
    places = (each.submodule_search_locations or filter(None, [each.origin]) for each in found)
    return frozenset(Path(place) for each in places for place in each)
