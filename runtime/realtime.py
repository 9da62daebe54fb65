"""Requests real-time privileges from the operating system and reports which ones were granted.

Call `prepare` from the loop's own thread, just before the first tick, with everything loaded: objects that exist by
then are excluded from garbage collection and locked into memory.
"""

from __future__ import annotations

import gc
import os
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from tailor.runtime.memory_lock import lock_memory

PRIORITY = 50  # of SCHED_FIFO: above ordinary work, below the kernel's own threads
BUS_PRIORITY = 40  # below the loop: a flood on the bus must not delay a tick
DRIVER_PRIORITY = 45
YOUNG, OLD = 1, 2  # generations of the garbage collector; an older one contains the younger ones
OLD_TICKS = 100
MAX_OLD_OBJECTS = 20_000  # visited in 10 ms; a search among two cups holds 300 000: 140 ms
_BUS_THREAD = re.compile(r"(app|net|acc|tx|rx)-\d+")  # zenoh's runtimes


def prepare(priority: int = PRIORITY) -> dict[str, Any]:
    """Freeze garbage collection, lock memory and schedule this thread under SCHED_FIFO.

    Correctness does not depend on any of them: a refusal is reported, never raised.

    Args:
      priority: SCHED_FIFO priority of the calling thread, 1 to 99.

    Returns:
      What was granted, for the provenance of a recording: gc, memory, scheduler, bus, threads.
    """
    gc.collect()
    gc.freeze()
    gc.disable()  # the loop calls collect_garbage() in its slack time instead
    return {
        "gc": "frozen",
        "memory": lock_memory(),
        "scheduler": take_fifo(priority),
        "bus": elevate_bus_threads(),
        "threads": os.environ.get("OMP_NUM_THREADS", "unset"),
    }


def collect_garbage(tick: int) -> None:
    """Collect garbage. Call it after the work of each tick, so that no collection interrupts a tick.

    Every tenth second also that of objects which have survived earlier collections, unless so many are alive, e.g. of
    a search that goes on, that to visit them would delay the next tick. What was loaded before `prepare` is frozen, so
    that this takes milliseconds. Work that a tick abandons must not wait for it: searches and proofs hold no cycles.

    Args:
      tick: Number of the tick.
    """
    old = tick % OLD_TICKS == 0 and len(gc.get_objects(OLD)) <= MAX_OLD_OBJECTS
    gc.collect(OLD if old else YOUNG)


def elevate_bus_threads(priority: int = BUS_PRIORITY) -> str:
    """Schedule zenoh's threads of this process under SCHED_FIFO; returns what was granted.

    A command that is published in time is late if it waits for a starved network thread. Call this again after zenoh
    may have started further threads.
    """
    elevated = 0
    for thread in Path("/proc/self/task").iterdir():
        try:
            if _BUS_THREAD.fullmatch((thread / "comm").read_text().strip()):
                # No reset on fork: the workers that such a thread starts later inherit its priority.
                os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(priority))
                elevated += 1
        except (FileNotFoundError, ProcessLookupError):
            continue  # the thread has ended, before its name was read or after
        except OSError as error:
            return f"default: {error.strerror}"
    return f"fifo {priority}, {elevated} threads"


@contextmanager
def inherited_fifo(priority: int = BUS_PRIORITY) -> Iterator[None]:
    """Schedule under SCHED_FIFO whatever threads the calling thread starts meanwhile; a refusal changes nothing.

    `elevate_bus_threads` knows a thread by the name that it gives itself. On a busy machine a thread may not have run
    yet when it looks: such a one would stay under ordinary scheduling. At the end this thread itself is scheduled as
    before.
    """
    with ExitStack() as restored:
        with suppress(OSError):
            before, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
            restored.callback(os.sched_setscheduler, 0, before, parameters)
        yield


def take_ordinary() -> None:
    """Schedule the calling thread as any other: it may have inherited the priority of the one that started it."""
    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def take_fifo(priority: int) -> str:
    """Schedule the calling thread under SCHED_FIFO; returns what was granted."""
    try:
        # Reset on fork: threads and processes that this thread starts later do not inherit the priority.
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(priority))
    except OSError as error:
        return f"default: {error.strerror}"
    return f"fifo {priority}"
