"""Stop requests by Ctrl-C, SIGTERM or a closed terminal; a loop polls them once a period.

A second signal of the same kind ends the process at once.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stop:
    """Flag that a stop of this process was requested."""

    def __init__(self) -> None:
        self.requested = False
        self._number: int = signal.SIGINT

    @property
    def exit_code(self) -> int:
        """Exit code of a command whose work was stopped before it was done, as a shell has it: 130 after Ctrl-C."""
        return 128 + self._number

    def request(self, number: int = 0, frame: FrameType | None = None) -> None:
        """Request a stop; also the signal handler, which restores the default action for a second signal."""
        self.requested = True
        if number:
            self._number = number
            signal.signal(number, signal.SIG_DFL)


def stop_on_signals() -> Stop:
    """Handle the signals that end a process, except ignored ones (nohup). Call it from the main thread."""
    stop = Stop()
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, stop.request)
    return stop


@contextmanager
def stoppable() -> Iterator[Stop]:
    """As `stop_on_signals`, for the length of a block that has to undo something before the process ends."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        yield stop_on_signals()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def interrupting(*numbers: signal.Signals) -> Iterator[list[int]]:
    """Let signals that would end the process at once raise KeyboardInterrupt in a block; yields those that arrived.

    After the first one they are ignored until the block has ended. Other threads than the main one have none.
    """
    arrived: list[int] = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        for each in ours:
            signal.signal(each, signal.SIG_IGN)  # another one must not interrupt the end
        arrived.append(number)
        raise KeyboardInterrupt

    in_main = threading.current_thread() is threading.main_thread()
    ours = [number for number in numbers if in_main and signal.getsignal(number) is signal.SIG_DFL]
    for each in ours:
        signal.signal(each, interrupt)
    try:
        yield arrived
    finally:
        for each in ours:
            signal.signal(each, signal.SIG_DFL)


@contextmanager
def undone_before_the_end() -> Iterator[None]:
    """Let a block that leaves nothing behind when it fails leave nothing at SIGTERM or a closing terminal either.

    Where they would end the process at once, they interrupt the block, and end the process behind it.
    """
    arrived = list[int]()
    try:
        with interrupting(signal.SIGTERM, signal.SIGHUP) as arrived:
            yield
    finally:
        for number in arrived:
            signal.raise_signal(number)
