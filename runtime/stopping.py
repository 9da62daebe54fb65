"""SIGINT and SIGTERM as a question that a loop asks between two turns; the second one ends the process at once."""

from __future__ import annotations

import signal
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


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
    """Take over SIGINT and SIGTERM; to be called from the main thread."""
    stop = Stop()
    for number in SIGNALS:
        signal.signal(number, stop.request)
    return stop
