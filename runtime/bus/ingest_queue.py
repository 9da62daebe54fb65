"""Bounded queue from zenoh's thread to the recorder: it never blocks the bus; it drops and counts messages."""

from __future__ import annotations

from collections import Counter, deque
from threading import Lock

from tailor.runtime.bus.inbox import Raw

MAX_BYTES = 32_000_000  # about five minutes of one robot's messages while the disk is stuck
OVERHEAD_BYTES = 500  # of a message in memory beside its payload: a flood of empty messages must not be free
MAX_COUNTED_KEYS = 1000  # a robot has about 30
OTHER_KEYS = "(other keys)"


def memory_of(raw: Raw) -> int:
    """Memory that a message takes, in bytes, about."""
    return len(raw.payload) + len(raw.key) + len(raw.encoding) + OVERHEAD_BYTES


def count_key(counts: Counter[str], key: str) -> None:
    """Count one message by its key; keys beyond the first MAX_COUNTED_KEYS are counted together."""
    counts[key if key in counts or len(counts) < MAX_COUNTED_KEYS else OTHER_KEYS] += 1


class IngestQueue:
    """Filled by callbacks of zenoh, drained by one reader."""

    def __init__(self, max_bytes: int = MAX_BYTES) -> None:
        self.received = 0
        self._drops: Counter[str] = Counter()
        self._max_bytes = max_bytes
        self._bytes = 0
        self._waiting: deque[Raw] = deque()
        self._lock = Lock()

    def put(self, raw: Raw) -> None:
        """Append a message, or drop and count it if the queue is full."""
        with self._lock:
            self.received += 1
            size = memory_of(raw)
            if self._bytes + size > self._max_bytes:
                count_key(self._drops, raw.key)
                return
            self._bytes += size
            self._waiting.append(raw)

    @property
    def drops(self) -> Counter[str]:
        """Messages dropped by this queue so far, by key."""
        with self._lock:
            return self._drops.copy()

    def drain(self) -> list[Raw]:
        """Remove and return all messages, oldest first."""
        with self._lock:
            messages = list(self._waiting)
            self._waiting.clear()
            self._bytes = 0
        return messages
