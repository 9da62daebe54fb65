"""Ends a process in order when code of a robot's package raises in the midst of a run."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

from tailor.schemas.errors import UsageError
from tailor.schemas.installed.package_errors import is_within
from tailor.schemas.packages.spec import DomainSpec
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
        passed = _entered(error.__traceback__, spec)
        if passed is None:
            raise
        print_traceback(error, passed)
        last = [line for line in traceback.extract_tb(passed) if is_within(line.filename, spec)][-1]
        text = f"{type(error).__name__}: {' '.join(str(error).split())}"
        place = f"{last.name}, {last.filename}, line {last.lineno}"
        raise UsageError(f"the package of {spec.name} raised {text} (in {place}); the robot is stopped") from error


def print_traceback(error: BaseException, at: TracebackType | None) -> None:
    """Print an error with a traceback on standard error, without control characters."""
    for line in "".join(traceback.format_exception(type(error), error, at)).splitlines():
        print(plain(line), file=sys.stderr)


def _entered(at: TracebackType | None, spec: DomainSpec) -> TracebackType | None:
    """The traceback from the first line in a package's code on; None if there is none."""
    while at is not None and not is_within(at.tb_frame.f_code.co_filename, spec):
        at = at.tb_next
    return at
