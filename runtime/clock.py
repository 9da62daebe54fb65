"""CLOCK_MONOTONIC in integer nanoseconds, the only clock of a process. Wall time only labels recordings."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Time source of a loop; tests inject their own."""

    def now_ns(self) -> int:
        """Nanoseconds since an arbitrary fixed point; never decreases."""
        ...

    def sleep_until(self, deadline_ns: int) -> None:
        """Return as soon as possible after `deadline_ns`; immediately if it has passed."""
        ...


class MonotonicClock:
    """CLOCK_MONOTONIC: independent of steps of the wall clock."""

    def now_ns(self) -> int:
        """Nanoseconds since boot."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Sleep until an absolute time; signal handlers may run in between."""
        while (left_ns := deadline_ns - time.monotonic_ns()) > 0:
            time.sleep(left_ns / 1e9)


def wall_ns() -> int:
    """Unix time in nanoseconds. It may jump, so no decision depends on it."""
    return time.time_ns()
