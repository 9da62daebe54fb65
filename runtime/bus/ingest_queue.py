"""The bounded queue between zenoh's thread and the recorder's: it never blocks the bus, it drops and counts."""

from __future__ import annotations

from collections import Counter, deque
from threading import Lock

from tailor.runtime.bus.inbox import Raw

MAX_BYTES = 32_000_000  # about a minute of a busy robot on a disk that has stopped


class IngestQueue:
    """Filled by callbacks, emptied by one reader."""

    def __init__(self, most_bytes: int = MAX_BYTES) -> None:
        self.drops: Counter[str] = Counter()  # messages lost here, by key
        self.received = 0
        self._most_bytes = most_bytes
        self._bytes = 0
        self._waiting: deque[Raw] = deque()
        self._lock = Lock()

    def put(self, raw: Raw) -> None:
        """Keep a message, or drop it when the queue is full: what is already in stays in order and whole."""
        with self._lock:
            self.received += 1
            if self._bytes + len(raw.payload) > self._most_bytes:
                self.drops[raw.key] += 1
                return
            self._bytes += len(raw.payload)
            self._waiting.append(raw)

    def drain(self) -> list[Raw]:
        """Everything that waits, oldest first."""
        with self._lock:
            taken = list(self._waiting)
            self._waiting.clear()
            self._bytes = 0
        return taken
