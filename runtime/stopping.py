"""Ctrl-C, SIGTERM and a terminal that closes, as a question that a loop asks between two turns.

The second signal of a kind ends the process at once.
"""

from __future__ import annotations

import signal
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stop:
    """Whether this process was asked to end."""

    def __init__(self) -> None:
        self.requested = False

    def request(self, number: int = 0, frame: FrameType | None = None) -> None:
        """Ask to end; also the signal handler, which then lets a second signal through."""
        self.requested = True
        if number:
            signal.signal(number, signal.SIG_DFL)


def stop_on_signals() -> Stop:
    """Take over the signals that end a process, but for those that nohup has it ignore; from the main thread."""
    stop = Stop()
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, stop.request)
    return stop
