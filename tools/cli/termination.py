"""Ends a command that has workers by SIGTERM as by Ctrl-C: they end with it, and what is finished is kept."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable

from tailor.runtime.stopping import interrupting

TERMINATED = 143  # exit code, as a shell has it


def interrupted_by_sigterm(run: Callable[[], int], name: str) -> int:
    """The exit code of `run`, in which SIGTERM raises KeyboardInterrupt; TERMINATED if it arrived.

    By default it would end this process alone: its workers would run on, and multiprocessing would complain of what
    they leave behind.

    Args:
      run: A command.
      name: Its name, for the one line about an end of which the command itself says nothing.
    """
    with interrupting(signal.SIGTERM) as arrived:
        try:
            code = run()
        except KeyboardInterrupt:
            if not arrived:
                raise
            print(f"{name}: ended by SIGTERM", file=sys.stderr)
    return TERMINATED if arrived else code
