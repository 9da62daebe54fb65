"""The one clock of a process: CLOCK_MONOTONIC in integer nanoseconds. Wall time only labels recordings."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """What a loop needs to know about time; a test hands in its own."""

    def now_ns(self) -> int:
        """Nanoseconds since some fixed point; never goes back."""
        ...

    def sleep_until(self, deadline_ns: int) -> None:
        """Return as soon as possible after `deadline_ns`; at once if it has passed."""
        ...


class MonotonicClock:
    """CLOCK_MONOTONIC: steps of the wall clock do not touch it."""

    def now_ns(self) -> int:
        """Nanoseconds since boot."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Sleep to an absolute time; a signal handler may run meanwhile."""
        while (left_ns := deadline_ns - time.monotonic_ns()) > 0:
            time.sleep(left_ns / 1e9)


def wall_ns() -> int:
    """Unix time in nanoseconds; it may jump, so nothing is decided by it."""
    return time.time_ns()
