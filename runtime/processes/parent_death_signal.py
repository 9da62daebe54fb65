"""Ties a process to the life of the one that started it, then becomes the program it was given.

Run as a script: `python leash.py PARENT_PID PROGRAM ARGUMENTS…`. The kernel sends SIGTERM when the parent dies, even
by kill -9. A script of its own because nothing but exec is safe between fork and exec in a process with threads.
"""

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1  # <sys/prctl.h>; survives exec


def main() -> None:
    """Set the leash and exec; end quietly if the parent has gone in between."""
    parent, program = int(sys.argv[1]), sys.argv[2:]
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() == parent:
        os.execvp(program[0], program)


if __name__ == "__main__":
    main()
