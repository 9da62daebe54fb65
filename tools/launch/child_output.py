"""What the launcher's children print, passed on line by line while they run: a crash shows its traceback at once."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import IO

MAX_BYTES = 65_536  # passed on in one poll; a child that prints more must not delay the supervision


class ChildOutput:
    """Reads the file that all children append to, without moving the position at which they write."""

    def __init__(self, file: IO[str], report: Callable[[str], None]) -> None:
        """`file` is the children's stdout and stderr; `report` receives each whole line."""
        self._file, self._report = file, report
        self._read = 0  # bytes
        self._rest = b""  # of a line that has no end yet

    def poll(self) -> bool:
        """Pass on the next lines; False if there is nothing new."""
        data = os.pread(self._file.fileno(), MAX_BYTES, self._read)
        self._read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        self._pass_on(lines)
        return bool(data)

    def finish(self) -> None:
        """Pass on all that is left, once the children have ended."""
        while self.poll():
            pass
        self._pass_on([self._rest] if self._rest else [])
        self._rest = b""

    def _pass_on(self, lines: list[bytes]) -> None:
        for line in lines:
            self._report(line.decode(errors="replace").rstrip("\r"))
