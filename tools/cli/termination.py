"""Ends a command that has workers by SIGTERM as by Ctrl-C: they end with it, and what is finished is kept."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType

TERMINATED = 143  # exit code, as a shell has it


def interrupted_by_sigterm(run: Callable[[], int], name: str) -> int:
    """The exit code of `run`, in which SIGTERM raises KeyboardInterrupt; TERMINATED if it arrived.

    By default it would end this process alone: its workers would run on, and multiprocessing would complain of what
    they leave behind.

    Args:
      run: A command.
      name: Its name, for the one line about an end of which the command itself says nothing.
    """
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) != signal.SIG_DFL:
        return run()
    arrived = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal arrived
        arrived = True
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # another one must not interrupt the end in order
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    try:
        code = run()
    except KeyboardInterrupt:
        if not arrived:
            raise
        print(f"{name}: ended by SIGTERM", file=sys.stderr)
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
    return TERMINATED if arrived else code
