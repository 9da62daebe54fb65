"""Standard streams that are closed, as a script or a service may start a program, or that take no more output."""

from __future__ import annotations

import errno
import io
import os
import sys

WRITTEN = {1: "stdout", 2: "stderr"}


def replace_closed_streams(prints: bool = False) -> None:
    """Put the null device in the place of each standard stream that is closed.

    Otherwise the next file that is opened takes its number, and gets what a library in C prints; and what Python prints
    to standard error, which is None then, goes to standard output. An absent `sys.stdin` stays so: it is no empty one.

    Args:
      prints: Whether the work of the command is what it prints, so that a closed standard output is an error.
    """
    is_closed = sys.stdout is None
    while (number := os.open(os.devnull, os.O_RDWR)) <= max(WRITTEN):  # the system gives the lowest free number
        os.set_inheritable(number, True)
        if number in WRITTEN:
            setattr(sys, WRITTEN[number], open(number, "w", encoding="utf-8", closefd=False))  # noqa: SIM115
    os.close(number)
    if prints and is_closed:
        sys.stdout = _ClosedOutput()


def drop_failed_output() -> None:
    """Leave the interpreter no output to write at its end if it fails again, with a traceback and exit code 120."""
    try:
        if sys.stdout:
            sys.stdout.flush()
    except OSError:
        sys.stdout = None


class _ClosedOutput(io.TextIOBase):
    """Raises an OSError for whatever is written."""

    def write(self, text: str) -> int:
        raise OSError(errno.EBADF, "standard output is closed, expected an open one")
