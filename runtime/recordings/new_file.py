"""Guard of a file that is being made: whole in the end, or gone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.schemas.errors import UsageError

EXISTS = "{}: exists already, expected the name of a new file"


@contextmanager
def new_file(path: Path) -> Iterator[None]:
    """Guard the block that creates and writes `path`; if the block fails, the file is removed.

    Raises:
      UsageError: The file existed before, which leaves it as it is, or cannot be written.
    """
    if path.exists():  # before anything can fail, or what fails would remove a file of the user's
        raise UsageError(EXISTS.format(path))
    try:
        yield
    except FileExistsError as error:
        raise UsageError(EXISTS.format(path)) from error
    except BaseException as error:
        with suppress(OSError):
            path.unlink()
        if isinstance(error, OSError):
            raise UsageError(f"{path}: {error.strerror}, expected a file that can be written") from error
        raise
