"""Script that requests SIGTERM at the death of its parent, heeds those that end a process, and executes a program.

Usage: `python parent_death_signal.py PARENT_PID PROGRAM ARGUMENTS…`. The kernel sends the signal even after
kill -9 of the parent. It is a script of its own, because only exec is safe between fork and exec in a process with
threads.

A process that a shell's script started in the background ignores Ctrl-C, and so would all that it starts.
"""

import ctypes
import os
import sys

PR_SET_PDEATHSIG = 1  # <sys/prctl.h>; survives exec
SIGINT, SIGTERM = 2, 15  # the module signal would take a third of this script's time; nohup's SIGHUP stays ignored


def request_at_parents_death(number: int) -> None:
    """Have the kernel send this signal to this process when its parent dies."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)


def heed_ends() -> None:
    """Give the signals that end this process in order their default action."""
    for number in (SIGINT, SIGTERM):
        ctypes.CDLL(None).signal(number, None)


def main() -> None:
    """Set the signals and exec; end silently if the parent has died meanwhile."""
    parent, program = int(sys.argv[1]), sys.argv[2:]
    request_at_parents_death(SIGTERM)
    heed_ends()
    if os.getppid() == parent:
        os.execvp(program[0], program)


if __name__ == "__main__":
    main()
