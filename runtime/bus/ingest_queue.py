"""Bounded queue from zenoh's thread to the recorder: it never blocks the bus; it drops and counts messages."""

from __future__ import annotations

from collections import Counter, deque
from threading import Lock

from tailor.runtime.bus.inbox import Raw

MAX_BYTES = 32_000_000  # about a minute of one robot's messages while the disk is stuck


class IngestQueue:
    """Filled by callbacks of zenoh, drained by one reader."""

    def __init__(self, max_bytes: int = MAX_BYTES) -> None:
        self.drops: Counter[str] = Counter()  # messages dropped by this queue, by key
        self.received = 0
        self._max_bytes = max_bytes
        self._bytes = 0
        self._waiting: deque[Raw] = deque()
        self._lock = Lock()

    def put(self, raw: Raw) -> None:
        """Append a message, or drop and count it if the queue is full."""
        with self._lock:
            self.received += 1
            if self._bytes + len(raw.payload) > self._max_bytes:
                self.drops[raw.key] += 1
                return
            self._bytes += len(raw.payload)
            self._waiting.append(raw)

    def drain(self) -> list[Raw]:
        """Remove and return all messages, oldest first."""
        with self._lock:
            messages = list(self._waiting)
            self._waiting.clear()
            self._bytes = 0
        return messages
