"""Non-blocking key presses from the terminal; reports none if there is no terminal."""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from contextlib import suppress
from typing import Any

KEYS = {b" ": "space", b"\x1b[A": "up", b"\x1b[B": "down", b"\x1b[C": "right", b"q": "quit", b"s": "right"}


class Keyboard:
    """Context manager that reads single keys and restores the terminal's settings at the end.

    After Ctrl-Z a shell sets its terminal up for whole lines, and leaves it so for a program that goes on: each look
    takes it again. In the background there are no keys: the system stops whoever touches the terminal there.
    """

    def __init__(self) -> None:
        self._saved: list[Any] | None = None
        self._unnamed = b""  # read, but not yet returned by `pressed`
        self._file = sys.stdin.fileno() if sys.stdin and sys.stdin.isatty() else None

    def __enter__(self) -> Keyboard:
        self.take()
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None and self._saved is not None and self.there:
            with suppress(termios.error):  # a terminal that has gone
                termios.tcsetattr(self._file, termios.TCSADRAIN, self._saved)

    @property
    def there(self) -> bool:
        """Whether there is a terminal to press keys in."""
        return self._file is not None and _in_foreground(self._file)

    def take(self) -> None:
        """Have single keys arrive at once, unless they do."""
        if self._file is None or not self.there:
            return
        with suppress(termios.error):  # a terminal that has gone
            settings = termios.tcgetattr(self._file)
            is_first = self._saved is None
            if is_first:
                self._saved = settings
            elif not settings[3] & termios.ICANON:
                return
            # What was typed before this program is not meant for it.
            tty.setcbreak(self._file, termios.TCSAFLUSH if is_first else termios.TCSANOW)
            settings = termios.tcgetattr(self._file)
            settings[0] &= ~termios.IXON  # Ctrl-S is a key like others: it stops no output, for which a loop would wait
            termios.tcsetattr(self._file, termios.TCSANOW, settings)

    def pressed(self) -> str:
        """Name of the next pressed key: space, up, down, right or quit; empty if there is none. Others are skipped."""
        self._unnamed += self.read()
        while self._unnamed:
            for code, name in KEYS.items():
                if self._unnamed.startswith(code):
                    self._unnamed = self._unnamed.removeprefix(code)
                    return name
            if any(code.startswith(self._unnamed) for code in KEYS):
                break  # the rest of an arrow key is on its way
            self._unnamed = self._unnamed[1:]
        return ""

    def read(self) -> bytes:
        """All bytes waiting, at most eight: of several keys pressed at once, none is lost; empty if there is none."""
        self.take()
        if self._file is None or not self.there or not select.select([self._file], [], [], 0)[0]:
            return b""
        return os.read(self._file, 8)


def _in_foreground(terminal: int) -> bool:
    """Whether this process may touch a terminal; also one that is not the terminal of its session, or has gone."""
    try:
        return os.tcgetpgrp(terminal) == os.getpgrp()
    except OSError:
        return True
