"""Keeps the last line that a child process writes to a pipe, such as its error output, however much it writes."""

from __future__ import annotations

import os
from typing import IO

CHUNK = 65536  # a full pipe
MAX_CHUNKS = 4  # in one read; a child may write as fast as it is read
KEPT = 4096  # bytes; a longer last line loses its beginning
MAX_CHARACTERS = 200  # of a quotation


class LastLine:
    """The end of what a child has written to a pipe, read without blocking."""

    def __init__(self, pipe: IO[bytes]) -> None:
        """`pipe`: owned from now on."""
        os.set_blocking(pipe.fileno(), False)
        self._pipe, self._end = pipe, b""

    def read(self) -> None:
        """Read what is there, up to a limit."""
        for _ in range(MAX_CHUNKS):
            try:
                chunk = os.read(self._pipe.fileno(), CHUNK)
            except BlockingIOError:
                return
            if not chunk:
                return
            self._end = (self._end + chunk)[-KEPT:]

    def close(self) -> None:
        """Read no more."""
        self._pipe.close()

    def quoted(self) -> str:
        """The last line that is not empty, in quotation marks and printable; empty if there is none."""
        lines = [line for line in map(str.strip, self._end.decode(errors="replace").splitlines()) if line]
        if not lines:
            return ""
        last = lines[-1] if len(lines[-1]) <= MAX_CHARACTERS else f"{lines[-1][: MAX_CHARACTERS - 3]}..."
        return repr(last)
