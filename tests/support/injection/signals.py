"""Signals as a process in a terminal has them: tests that run by `nohup` or in the background ignore some."""

import signal
from contextlib import contextmanager

from tailor.runtime.stopping import SIGNALS


@contextmanager
def heeded_signals():
    """This process and the children that it starts meanwhile heed those that stop one; what was before comes back."""
    before = {number: signal.signal(number, signal.SIG_DFL) for number in SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
