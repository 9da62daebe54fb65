"""Asks the operating system for the privileges of a real-time loop, and says which ones it got.

Call it last before the first tick, from the loop's own thread, with everything loaded and warmed up: what is
allocated by then is frozen out of garbage collection and locked into memory.
"""

from __future__ import annotations

import ctypes
import gc
import os
import resource
from typing import Any

PRIORITY = 50  # of SCHED_FIFO: above ordinary work, below the kernel's own threads
_MCL_CURRENT, _MCL_FUTURE = 1, 2  # <sys/mman.h>


def prepare(priority: int = PRIORITY) -> dict[str, Any]:
    """Freeze garbage collection, lock memory, take SCHED_FIFO for this thread; report what was obtained.

    Nothing here is needed for correctness: a refusal is reported, never raised.
    """
    gc.collect()
    gc.freeze()
    gc.disable()  # the loop calls collect_young() in its slack instead
    return {
        "gc": "frozen",
        "memory": _lock_memory(),
        "scheduler": _take_fifo(priority),
        "threads": os.environ.get("OMP_NUM_THREADS", "unset"),
    }


def collect_young() -> None:
    """Collect young garbage; call it when the tick's work is done, so that it never interrupts a tick."""
    gc.collect(1)


def _lock_memory() -> str:
    soft, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    if os.geteuid() != 0 and soft != resource.RLIM_INFINITY:
        return f"not locked: limited to {soft} bytes"  # locking later pages would then fail in the middle of a run
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mlockall(_MCL_CURRENT | _MCL_FUTURE) != 0:
        return f"not locked: {os.strerror(ctypes.get_errno())}"
    return "locked"


def _take_fifo(priority: int) -> str:
    try:
        # Reset on fork: threads and processes that this thread starts later do not inherit the priority.
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except OSError as error:
        return f"default: {error.strerror}"
    return f"fifo {priority}"
