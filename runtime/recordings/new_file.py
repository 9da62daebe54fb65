"""Files that are to be new: whether one can be made, and a guard while it is: whole in the end, or gone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile

from tailor.runtime.stopping import undone_before_the_end
from tailor.schemas.errors import UsageError

PROBE_BYTES = 65_536  # there must be room for: a second of a run
EXISTS = "{}: exists already, expected the name of a new file"


def check_new_file(path: Path) -> None:
    """Make the folder of a file, and check that the file can be made there: before a run begins, of which it is.

    Raises:
      UsageError: It exists, or cannot be made.
    """
    if path.exists():
        raise UsageError(EXISTS.format(path))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("xb") as file:
            try:
                file.write(bytes(PROBE_BYTES))
                file.flush()
            finally:
                path.unlink()
    except FileExistsError as error:  # also a file in the place of the folder
        raise UsageError(EXISTS.format(error.filename or path)) from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a file that can be written") from error


def check_room(folder: Path) -> None:
    """Check that a recording can begin in a folder, with a file that nobody sees; raises OSError if it cannot."""
    with TemporaryFile(dir=folder) as file:
        file.write(bytes(PROBE_BYTES))
        file.flush()


@contextmanager
def new_file(path: Path) -> Iterator[None]:
    """Guard the block that creates and writes `path`; if the block fails, or a signal ends it, the file is removed.

    Raises:
      UsageError: The file existed before, which leaves it as it is, or cannot be written.
    """
    if path.exists():  # before anything can fail, or what fails would remove a file of the user's
        raise UsageError(EXISTS.format(path))
    with undone_before_the_end():
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
