"""Prints what a process waits for and does, a line per change, beside a loop that must never wait for a terminal."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator, Sequence

from tailor.runtime.aside import FINISH_S
from tailor.runtime.realtime import take_ordinary
from tailor.schemas.reason_text import without_numbers
from tailor.tools.cli.plain_text import note, plain

PERIOD_S = 0.2
SELDOM_S = 10.0


@contextlib.contextmanager
def state_lines(*texts: Callable[[], str]) -> Iterator[None]:
    """Print each text whenever it has changed in more than its numbers, all from one thread, so that lines stay whole.

    Args:
      texts: Each returns a present state in one line; empty: nothing to print. They are called in the thread.
    """
    ended = threading.Event()
    thread = threading.Thread(target=_print, args=(texts, ended), name="state lines", daemon=True)
    if texts:
        thread.start()
    try:
        yield
    finally:
        ended.set()
        if texts:
            thread.join(FINISH_S)


def seldom(text: Callable[[], str], now_s: Callable[[], float] = time.monotonic) -> Callable[[], str]:
    """The text, which changes at once, and then not again for SELDOM_S: a broken sensor may change it all the time."""
    last, due_s = "", now_s()

    def renewed() -> str:
        nonlocal last, due_s
        if now_s() >= due_s and (line := text()) != last:
            last, due_s = line, now_s() + SELDOM_S
        return last

    return renewed


def _print(texts: Sequence[Callable[[], str]], ended: threading.Event) -> None:
    take_ordinary()
    last = [""] * len(texts)
    while True:
        over = ended.wait(PERIOD_S)
        for number, text in enumerate(texts):
            line = text()
            if line and without_numbers(line) != last[number]:
                last[number] = without_numbers(line)
                note(plain(line))
        if over:
            return
