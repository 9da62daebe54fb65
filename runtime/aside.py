"""Makes calls beside a loop that must never wait for them, such as output to a terminal that stands still (Ctrl-S)."""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial

from tailor.runtime.realtime import take_ordinary

FINISH_S = 1.0  # a terminal that is stopped must not keep the process


class Aside:
    """Makes calls one after another in a thread of its own. Make it with `aside`."""

    def __init__(self, most: int) -> None:
        """`most`: calls that may wait; the oldest ones give way to further ones."""
        self._waiting: deque[Callable[[], object]] = deque(maxlen=most)
        self._changed, self._ended = threading.Event(), False
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._run, name="aside", daemon=True)
        self._thread.start()

    def call(self, function: Callable[[], object]) -> None:
        """Have a call made; returns at once.

        Raises:
          Exception: What an earlier call has raised, e.g. BrokenPipeError; no call is made any more.
        """
        if self._error is not None:
            raise self._error
        self._waiting.append(function)
        self._changed.set()

    def output(self, function: Callable[[], object]) -> None:
        """Have output made that may be lost: where a disk is full, or nobody reads it any more, the loop goes on."""
        self.call(partial(_output, function))

    def finish(self) -> None:
        """Wait until all calls are made, but no longer than FINISH_S."""
        self._ended = True
        self._changed.set()
        self._thread.join(FINISH_S)

    def _run(self) -> None:
        take_ordinary()
        try:
            while not self._ended or self._waiting:
                self._changed.wait()
                self._changed.clear()
                while self._waiting:
                    self._waiting.popleft()()
        except Exception as error:
            self._error = error


def _output(function: Callable[[], object]) -> None:
    with contextlib.suppress(OSError):
        function()


@contextlib.contextmanager
def aside(most: int = 1000) -> Iterator[Aside]:
    """Yields an `Aside`; at the end it finishes."""
    made = Aside(most)
    try:
        yield made
    finally:
        made.finish()
