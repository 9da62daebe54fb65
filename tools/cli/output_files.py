"""Files that a command is to write: names checked before it works for them, contents whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.runtime.stopping import undone_before_the_end
from tailor.schemas.errors import UsageError

PERMISSIONS = 0o777


def check_output(flag: str, output: Path, suffixes: Sequence[str]) -> None:
    """Refuse a file of another kind, so that no recording is overwritten, and a folder.

    Args:
      flag: How the file was named, e.g. "--output".
      output: The file.
      suffixes: The legal ends of its name in lower case, e.g. (".png",).

    Raises:
      UsageError: It may not be written.
    """
    if output.suffix.lower() not in suffixes:
        *others, last = suffixes
        expected = f"{', '.join(others)} or {last}" if others else last
        raise UsageError(f"{flag} {output}: expected a name that ends in {expected}")
    if output.is_dir():
        raise UsageError(f"{flag} {output}: is a folder, expected a file")


def beside(recording: Path, ending: str) -> Path:
    """The file that is made of a recording unless another one is named: run-scene.mcap beside run.mcap.

    Raises:
      UsageError: The recording is a folder, beside which no file has its name.
    """
    if recording.is_dir():
        raise UsageError(f"{recording}: Is a directory, expected a recording")
    return recording.with_name(f"{recording.stem}{ending}")


@contextmanager
def whole_output(output: Path) -> Iterator[Path]:
    """Path to write to in the block, at whose end the file takes its place, its folder made: whole, or not at all.

    What ends the block, as a full disk, Ctrl-C or SIGTERM, leaves a file of that name as it was. A device or a pipe is
    written to as it is, never replaced by a file.

    Raises:
      UsageError: The file cannot be written.
    """
    place = Path(os.path.realpath(output))  # through a symbolic link, as other programs write
    temporary = place.with_name(f".{os.getpid()}{place.suffix}")  # libraries choose the format by the suffix
    if place.exists() and not os.access(place, os.W_OK):
        raise UsageError(f"{output}: is read-only, expected a file that can be written")
    with undone_before_the_end():
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            is_device = place.exists() and not place.is_file()
            yield place if is_device else temporary
            if not is_device:
                if place.exists():  # whom its user lets read it
                    temporary.chmod(place.stat().st_mode & PERMISSIONS)
                temporary.replace(place)
        except OSError as error:
            raise UsageError(f"{output}: {error.strerror or error}, expected a file that can be written") from error
        finally:
            with suppress(OSError):
                temporary.unlink()


def check_writable(flag: str, output: Path) -> None:
    """Make the folder of a file, and refuse a file that cannot be written: before hours of work, not after them.

    Raises:
      UsageError: It cannot be written. One that is there is unchanged.
    """
    existed = output.exists()
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.open("ab").close()
    except OSError as error:
        raise UsageError(f"{flag} {output}: {error.strerror}, expected a file that can be written") from error
    if not existed:
        output.unlink()
