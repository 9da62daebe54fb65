"""Reads the domain and problem of `tailor plan`: two files, one that holds both, or standard input."""

from __future__ import annotations

import sys
from codecs import BOM_UTF8
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import BinaryIO

from tailor.executive.planning.pddl.syntax.definitions import split_definitions
from tailor.executive.planning.pddl.syntax.errors import error_at, place_of
from tailor.executive.planning.pddl.syntax.s_expressions import MAX_CHARACTERS
from tailor.schemas.errors import UsageError

MAX_BYTES = 4 * MAX_CHARACTERS


def read_texts(files: list[Path]) -> tuple[str, str]:
    """The text of the domain and of the problem; an empty list becomes standard input."""
    if len(files) > 2:
        raise UsageError(f"expected at most two files, found {len(files)}")
    if not files:
        files.append(Path("-"))
    if [str(file) for file in files] == ["-", "-"]:
        raise UsageError("standard input is named twice; name it once if it holds both the domain and the problem")
    if len(files) == 2:
        return _read(files[0]), _read(files[1])
    return split_definitions(_read(files[0]), str(files[0]))


def _read(path: Path) -> str:
    try:
        with _standard_input() if str(path) == "-" else path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)  # a device or a pipe has no size
        if len(content) > MAX_BYTES:
            raise UsageError(f"{path}: more than the {MAX_BYTES} bytes allowed in a PDDL file")
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from None
    return _decoded(content.removeprefix(BOM_UTF8), str(path))  # some editors begin a file with a byte order mark


def _standard_input() -> AbstractContextManager[BinaryIO]:
    if sys.stdin is None:  # as a service or `<&-` starts a program
        raise UsageError("-: cannot be read: standard input is closed")
    return nullcontext(sys.stdin.buffer)


def _decoded(content: bytes, source: str) -> str:
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        before = content[: error.start].decode()
        what = f"the byte 0x{content[error.start]:02x} is not UTF-8"
        raise error_at(source, *place_of(before, len(before)), what) from None
