"""Names the package of a robot, in one line, where what it declares fails in a run of this command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.schemas.installed.package_errors import blamed_on_package, came_through
from tailor.tools.cli.package_run import print_traceback


@contextmanager
def blamed_on_run(domain: str, parts_alone: bool = False) -> Iterator[None]:
    """Raise errors as a UsageError that names the package of `domain`, and its line if they came through it.

    Those of robots that ship, and of domains that no package declares, stay as they are. The traceback of one that did
    not come through the package's code is printed first: the package may have passed what we cannot use, or the fault
    is ours.

    Args:
      domain: Its name; looked up only where something is raised.
      parts_alone: Leave what no part of a pool has raised (pool.py), such as the command's own full disk.
    """
    try:
        yield
    except UsageError:
        raise
    except Exception as error:
        if parts_alone and not hasattr(error, "raised_at"):
            raise
        try:
            spec = spec_of(domain)
        except UsageError:
            raise error from None
        if not spec.package.startswith("tailor.") and not came_through(error, spec):
            print_traceback(error, error.__traceback__)
        with blamed_on_package(spec, f"the package of {domain} cannot be run"):
            raise
