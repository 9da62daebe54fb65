"""Restart policy of a child: exponential back-off, and a limit for crash loops. Pure: the caller passes the time."""

from __future__ import annotations

from collections import deque

FIRST_DELAY_NS = 200_000_000
MAX_DELAY_NS = 5_000_000_000
MAX_STARTS = 5  # within WINDOW_NS; more count as a crash loop
WINDOW_NS = 60_000_000_000


class Restart:
    """Recent starts of one child, and the delay before its next one."""

    def __init__(self) -> None:
        self._starts: deque[int] = deque(maxlen=MAX_STARTS)

    def started(self, now_ns: int) -> None:
        """Record a start, including the first one."""
        self._starts.append(now_ns)

    def exhausted(self, now_ns: int) -> bool:
        """Whether the child was started too often in the last minute to be started again."""
        return len(self._starts) == MAX_STARTS and now_ns - self._starts[0] < WINDOW_NS

    def delay_ns(self, now_ns: int) -> int:
        """Delay before the next start: 0.2 s, doubled for every start in the last minute, at most 5 s."""
        recent = sum(now_ns - start < WINDOW_NS for start in self._starts)
        return min(FIRST_DELAY_NS << max(0, recent - 1), MAX_DELAY_NS)
