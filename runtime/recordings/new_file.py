"""Guard of a file that is being made: whole in the end, or gone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.schemas.errors import UsageError


@contextmanager
def new_file(path: Path) -> Iterator[None]:
    """Guard the block that creates and writes `path`; if the block fails, the file is removed.

    Raises:
      UsageError: The file existed before, which leaves it as it is, or cannot be written.
    """
    try:
        yield
    except FileExistsError as error:
        raise UsageError(f"{path}: exists already, expected the name of a new file") from error
    except BaseException as error:
        with suppress(OSError):
            path.unlink()
        if isinstance(error, OSError):
            raise UsageError(f"{path}: {error.strerror}, expected a file that can be written") from error
        raise
