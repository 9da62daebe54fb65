"""What the launcher's children print, passed on line by line while they run: a crash shows its traceback at once.

Bounded in a system of weeks: of the file, what has been passed on takes no space; of a flood, the newest end is read.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from typing import IO

MAX_BYTES = 65_536  # passed on in one poll; a child that prints more must not delay the supervision
MAX_LINE = 65_536  # bytes; what is longer is passed on in parts
MAX_WAITING = 16 << 20  # bytes not passed on yet; of more the oldest are left out
FREE_BYTES = 1 << 20  # passed on between two releases of their space
_KEEP_SIZE, _PUNCH_HOLE = 1, 2  # <linux/falloc.h>


class ChildOutput:
    """Reads the file that all children append to, without moving the position at which they write."""

    def __init__(self, file: IO[str], report: Callable[[str], None]) -> None:
        """`file` is the children's stdout and stderr; `report` receives each whole line."""
        self._file, self._report = file, report
        self._read = self._freed = 0  # bytes
        self._rest = b""  # of a line that has no end yet

    def poll(self) -> bool:
        """Pass on the next lines; False if there is nothing new."""
        self._leave_out()
        data = os.pread(self._file.fileno(), MAX_BYTES, self._read)
        self._read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        self._pass_on(lines)
        if len(self._rest) > MAX_LINE:
            self._end_line()
        if self._read - self._freed >= FREE_BYTES:
            self._free()
        return bool(data)

    def finish(self) -> None:
        """Pass on all that is left, once the children have ended."""
        while self.poll():
            pass
        self._end_line()

    def _leave_out(self) -> None:
        """Of more than MAX_WAITING bytes, skip the oldest: the newest state why a child has ended."""
        left_out = os.fstat(self._file.fileno()).st_size - MAX_WAITING - self._read
        if left_out > 0:
            self._end_line()
            self._report(f"[{left_out} bytes that were printed too quickly are left out]")
            self._read += left_out

    def _free(self) -> None:
        """Give the space of what has been read back; a system that cannot do so keeps it.

        To truncate the file would lose what a child prints meanwhile.
        """
        if (free := getattr(ctypes.CDLL(None), "fallocate", None)) is not None:
            begin, size = (ctypes.c_long(number) for number in (self._freed, self._read - self._freed))
            free(self._file.fileno(), _KEEP_SIZE | _PUNCH_HOLE, begin, size)
        self._freed = self._read

    def _end_line(self) -> None:
        self._pass_on([self._rest] if self._rest else [])
        self._rest = b""

    def _pass_on(self, lines: list[bytes]) -> None:
        for line in lines:
            self._report(line.decode(errors="replace").rstrip("\r"))
