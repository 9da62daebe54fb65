"""Prints what a process waits for and does, a line per change, beside a loop that must never wait for a terminal."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

from tailor.runtime.aside import FINISH_S
from tailor.runtime.realtime import take_ordinary
from tailor.schemas.reason_text import without_numbers
from tailor.tools.cli.plain_text import note, plain

PERIOD_S = 0.2


@contextlib.contextmanager
def state_lines(text: Callable[[], str], wanted: bool = True) -> Iterator[None]:
    """Print a text whenever it has changed in more than its numbers, from a thread of its own.

    Args:
      text: Returns the present state in one line; empty: nothing to print. It is called in the thread.
      wanted: False: print nothing, for a process whose supervisor reports its state.
    """
    ended = threading.Event()
    thread = threading.Thread(target=_print, args=(text, ended), name="state lines", daemon=True)
    if wanted:
        thread.start()
    try:
        yield
    finally:
        ended.set()
        if wanted:
            thread.join(FINISH_S)


def _print(text: Callable[[], str], ended: threading.Event) -> None:
    take_ordinary()
    last = ""
    while True:
        over = ended.wait(PERIOD_S)
        line = text()
        if line and without_numbers(line) != last:
            last = without_numbers(line)
            note(plain(line))
        if over:
            return
