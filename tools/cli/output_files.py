"""Names of files that a command is to write, checked before it works for them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tailor.schemas.errors import UsageError


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
