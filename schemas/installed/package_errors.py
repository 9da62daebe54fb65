"""Errors that code of a robot's package raises, in one line for people."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import DomainSpec


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
    here = [(line.filename, line.lineno) for line in traceback.extract_tb(error.__traceback__)]
    lines = getattr(error, "raised_at", here)  # of an error from another process, which has its lines as an attribute
    folders = _folders(spec) if spec is not None else ()
    file, line = next((each for each in reversed(lines) if Path(each[0]).parent in folders), lines[-1])
    return f"{type(error).__name__}: {' '.join(str(error).split())} ({Path(file).name}, line {line})"


def _folders(spec: DomainSpec) -> set[Path]:
    modules = [written.partition(":")[0] for written in (spec.domain, spec.body, spec.sampler)]
    return {Path(found.origin).parent for found in map(find_spec, filter(None, modules)) if found and found.origin}
