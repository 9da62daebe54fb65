"""Keeps loky's manager thread from printing a traceback where a command is interrupted while it passes on its calls."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial

MANAGER = "ExecutorManagerThread"


def quieten_shutdown() -> None:
    """Say nothing of calls that a manager misses because its workers are being killed: they were cancelled before.

    loky looks for them once more after it has cancelled them (process_executor.py: add_call_item_to_queue). Other
    exceptions of threads are printed as before.
    """
    hook = threading.excepthook
    if not (isinstance(hook, partial) and hook.func is _unless_shut_down):
        threading.excepthook = partial(_unless_shut_down, hook)


def _unless_shut_down(print_it: Callable[[threading.ExceptHookArgs], object], raised: threading.ExceptHookArgs) -> None:
    flags = getattr(raised.thread, "executor_flags", None)
    cancelled = raised.exc_type is KeyError and getattr(flags, "kill_workers", False)
    if not (cancelled and raised.thread is not None and raised.thread.name == MANAGER):
        print_it(raised)
