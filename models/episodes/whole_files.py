"""Writes files of a data set whole or not at all, so that gathering can be interrupted at any time."""

from __future__ import annotations

import os
from pathlib import Path

from tailor.schemas.errors import UsageError


def write_whole(path: Path, content: bytes) -> None:
    """Write a file at once; what an interruption leaves beside it ends with .tmp.

    Raises:
      UsageError: It cannot be written, as on a full disk, whose error names no file.
    """
    temporary = path.with_suffix(f".{os.getpid()}.tmp")
    try:
        temporary.write_bytes(content)
        temporary.replace(path)
    except OSError as error:
        if temporary.exists():
            temporary.unlink()
        raise UsageError(f"{path}: {error.strerror}, expected a file that can be written; finished ones stay") from None
