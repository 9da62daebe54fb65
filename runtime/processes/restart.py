"""When a dead child may start again: back-off that doubles, and giving up on a crash loop. Pure: time is handed in."""

from __future__ import annotations

from collections import deque

FIRST_DELAY_NS = 200_000_000
MAX_DELAY_NS = 5_000_000_000
MAX_STARTS = 5  # within WINDOW_NS; after that it is a crash loop
WINDOW_NS = 60_000_000_000


class Restart:
    """The starts of one child, and what follows from them."""

    def __init__(self) -> None:
        self._starts: deque[int] = deque(maxlen=MAX_STARTS)

    def started(self, now_ns: int) -> None:
        """Note a start, the first one too."""
        self._starts.append(now_ns)

    def exhausted(self, now_ns: int) -> bool:
        """Whether there were too many starts in the last minute to try again."""
        return len(self._starts) == MAX_STARTS and now_ns - self._starts[0] < WINDOW_NS

    def delay_ns(self, now_ns: int) -> int:
        """How long to wait before the next start: 0.2 s, doubling with every start in the last minute, up to 5 s."""
        recent = sum(now_ns - start < WINDOW_NS for start in self._starts)
        return min(FIRST_DELAY_NS << max(0, recent - 1), MAX_DELAY_NS)
