"""Asks the operating system for the privileges of a real-time loop, and says which ones it got.

Call it last before the first tick, from the loop's own thread, with everything loaded and warmed up: what is
allocated by then is frozen out of garbage collection and locked into memory.
"""

from __future__ import annotations

import ctypes
import gc
import os
import re
import resource
from pathlib import Path
from typing import Any

PRIORITY = 50  # of SCHED_FIFO: above ordinary work, below the kernel's own threads
BUS_PRIORITY = 40  # below the loop: a flood on the bus must not delay a tick
DRIVER_PRIORITY = 45
_BUS_THREAD = re.compile(r"(app|net|acc|tx|rx)-\d+")  # zenoh's runtimes
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
        "scheduler": take_fifo(priority),
        "bus": elevate_bus_threads(),
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


def elevate_bus_threads(priority: int = BUS_PRIORITY) -> str:
    """SCHED_FIFO for zenoh's threads in this process; call it again when a new kind of thread may have come up.

    A command that is published in time and then waits for a starved network thread comes too late all the same.
    """
    elevated = 0
    for thread in Path("/proc/self/task").iterdir():
        try:
            if _BUS_THREAD.fullmatch((thread / "comm").read_text().strip()):
                # No reset on fork: the workers that such a thread starts later inherit its priority.
                os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(priority))
                elevated += 1
        except FileNotFoundError:
            continue  # it has ended meanwhile
        except OSError as error:
            return f"default: {error.strerror}"
    return f"fifo {priority}, {elevated} threads"


def take_fifo(priority: int) -> str:
    """SCHED_FIFO for the calling thread; what was obtained."""
    try:
        # Reset on fork: threads and processes that this thread starts later do not inherit the priority.
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except OSError as error:
        return f"default: {error.strerror}"
    return f"fifo {priority}"
