"""SHA-256 of every file of a folder, in the format of `sha256sum`; written on the way out, checked on the way in."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from pathlib import Path

from tailor.schemas.errors import UsageError

CHECKSUMS = "SHA256SUMS"
LINE = re.compile(r"([0-9a-f]{64})  ((?:\w[\w.-]*/)*\w[\w.-]*)")  # paths stay inside of the folder


def write_checksums(folder: Path, files: Iterable[Path]) -> None:
    """List files of a folder, paths relative to it."""
    rows = [f"{_sha256(folder / file)}  {file.as_posix()}\n" for file in sorted(files)]
    (folder / CHECKSUMS).write_text("".join(rows), encoding="utf-8")


def checked_files(folder: Path) -> list[Path]:
    """The listed files of a folder, paths relative to it.

    Raises:
      UsageError: There is no list, a file is missing or differs, or the list is none.
    """
    try:
        lines = (folder / CHECKSUMS).read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        raise UsageError(f"there is no {CHECKSUMS}, expected what `tailor models push` wrote") from None
    found = [LINE.fullmatch(line) for line in lines]
    rows = [(match[1], Path(match[2])) for match in found if match]
    if len(rows) < len(lines) or not rows:
        raise UsageError(f"{CHECKSUMS} is no list of checksums, expected what `tailor models push` wrote")
    for sha256, file in rows:
        if not (folder / file).is_file():
            raise UsageError(f"{file} is missing, but listed in {CHECKSUMS}")
        if (actual := _sha256(folder / file)) != sha256:
            raise UsageError(f"{file}: sha256 is {actual[:12]}…, expected {sha256[:12]}… by {CHECKSUMS}")
    return [file for _, file in rows]


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
