"""SHA-256 of every file of a folder, in the format of `sha256sum`; written on the way out, checked on the way in."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection
from pathlib import Path

from tailor.schemas.errors import UsageError

CHECKSUMS = "SHA256SUMS"
MAX_BYTES = 10_000_000  # of a list that is read whole: more than 50,000 files
NAME = re.compile(r"(?:\w[\w.-]*/)*\w[\w.-]*")  # such paths stay inside of the folder
LINE = re.compile(rf"([0-9a-f]{{64}})  ({NAME.pattern})")


def write_checksums(folder: Path, files: Collection[Path]) -> None:
    """List files of a folder, paths relative to it.

    Raises:
      UsageError: A name has another character than those that `checked_files` takes.
    """
    for file in files:
        if not NAME.fullmatch(file.as_posix()):
            raise UsageError(f"{file}: expected names of letters, digits, _, . and -, the first no . or -")
    rows = [f"{_sha256(folder / file)}  {file.as_posix()}\n" for file in sorted(files)]
    (folder / CHECKSUMS).write_text("".join(rows), encoding="utf-8")


def checked_files(folder: Path, kind: str) -> list[Path]:
    """The listed files of a folder, paths relative to it.

    Args:
      folder: What was fetched of a place: the files of models or of data sets, and the list.
      kind: "model" or "dataset", for errors.

    Raises:
      UsageError: There is no list, a file is missing or differs, or the list is none or of the other kind.
    """
    try:
        lines = (folder / CHECKSUMS).read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        raise UsageError(f"there is no {CHECKSUMS}, expected what `tailor models push` wrote") from None
    found = [LINE.fullmatch(line) for line in lines]
    rows = [(match[1], Path(match[2])) for match in found if match]
    if len(rows) < len(lines) or not rows:
        raise UsageError(f"{CHECKSUMS} is no list of checksums, expected what `tailor models push` wrote")
    if not any((folder / file).is_file() for _, file in rows):
        raise UsageError(f"{CHECKSUMS} lists no file of a {kind}; --data stands for data sets, no --data for models")
    for sha256, file in rows:
        if not (folder / file).is_file():
            raise UsageError(f"{file} is missing, but listed in {CHECKSUMS}")
        if (actual := _sha256(folder / file)) != sha256:
            raise UsageError(f"{file}: sha256 is {actual[:12]}…, expected {sha256[:12]}… by {CHECKSUMS}")
    return [file for _, file in rows]


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
