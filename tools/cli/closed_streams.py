"""Standard streams that are closed, as a script or a service may start a program: `tailor record >&- 2>&-`."""

from __future__ import annotations

import os
import sys

WRITTEN = {1: "stdout", 2: "stderr"}


def replace_closed_streams() -> None:
    """Put the null device in the place of each standard stream that is closed.

    Otherwise the next file that is opened takes its number, and gets what a library in C prints; and what Python prints
    to standard error, which is None then, goes to standard output. An absent `sys.stdin` stays so: it is no empty one.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= max(WRITTEN):  # the system gives the lowest free number
        os.set_inheritable(number, True)
        if number in WRITTEN:
            setattr(sys, WRITTEN[number], open(number, "w", encoding="utf-8", closefd=False))  # noqa: SIM115
    os.close(number)
