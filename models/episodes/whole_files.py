"""Writes files of a data set whole or not at all, by one process: gathering can be interrupted at any time."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.schemas.errors import UsageError


def write_whole(path: Path, content: bytes) -> None:
    """Write a file at once; what an interruption leaves beside it ends with .tmp.

    Raises:
      UsageError: It cannot be written, as on a full disk, whose error names no file.
    """
    temporary = path.with_suffix(f".{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # else a power cut may leave the name without the content: a part that seems done
        temporary.replace(path)
    except OSError as error:
        if temporary.exists():
            temporary.unlink()
        raise UsageError(f"{path}: {error.strerror}, expected a file that can be written; finished ones stay") from None


@contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Hold a folder of data sets, made if there is none: nobody else gathers into it. A kill releases it.

    Raises:
      UsageError: Another process holds it.
    """
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        opened = os.open(folder, os.O_RDONLY)
    except OSError:  # which a write there reports
        yield
        return
    try:
        _lock(opened, folder)
        yield
    finally:
        os.close(opened)
        for each in made:  # as they were, where nothing was gathered
            with suppress(OSError):
                each.rmdir()


def _lock(opened: int, folder: Path) -> None:
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise UsageError(f"{folder}: another process gathers into it, expected another folder, or its end") from None
    except OSError:  # some network file systems lock no folders: they go without
        return
