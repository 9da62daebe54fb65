"""Reads the domain and problem of `tailor plan`: two files, one that holds both, or standard input."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path

from tailor.executive.planning.pddl.definitions import split_definitions
from tailor.executive.planning.pddl.s_expressions import MAX_CHARACTERS
from tailor.schemas.errors import UsageError

MAX_BYTES = 4 * MAX_CHARACTERS


def read_texts(files: list[Path]) -> tuple[str, str]:
    """The text of the domain and of the problem; an empty list becomes standard input."""
    if len(files) > 2:
        raise UsageError(f"expected at most two files, found {len(files)}")
    if not files:
        files.append(Path("-"))
    if len(files) == 2:
        return _read(files[0]), _read(files[1])
    return split_definitions(_read(files[0]), str(files[0]))


def _read(path: Path) -> str:
    try:
        with nullcontext(sys.stdin.buffer) if str(path) == "-" else path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)  # a device or a pipe has no size
        if len(content) > MAX_BYTES:
            raise UsageError(f"{path}: more than the {MAX_BYTES} bytes allowed in a PDDL file")
        return content.decode("utf-8-sig")  # some editors begin a file with a byte order mark
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or 'it is not UTF-8'}") from None
