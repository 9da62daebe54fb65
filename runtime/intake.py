"""The bounded queue between zenoh's thread and the recorder's: it never blocks the bus, it drops and counts."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable
from threading import Lock
from typing import Any

from runtime.clock import wall_ns
from runtime.inbox import Raw

MOST_BYTES = 32_000_000  # about a minute of a busy robot on a disk that has stopped


Read = Callable[[Any, int], Raw]  # makes a Raw of what came, and of the wall time when it came


class Intake:
    """Filled by callbacks, emptied by one reader, who also does the reading: each callback waits for Python's lock."""

    def __init__(self, most_bytes: int = MOST_BYTES, read: Read = lambda raw, _: raw) -> None:
        """`read` is called by `take`, for whatever has a `payload` and was put."""
        self.drops: Counter[str] = Counter()  # messages lost here, by key
        self.received = 0
        self._most_bytes = most_bytes
        self._read = read
        self._bytes = 0
        self._waiting: deque[tuple[Any, int]] = deque()
        self._lock = Lock()

    def put(self, message: Any) -> None:
        """Keep a message, or drop it when the queue is full: what is already in stays in order and whole."""
        size = len(message.payload)
        with self._lock:
            self.received += 1
            if self._bytes + size > self._most_bytes:
                self.drops[self._read(message, 0).key] += 1
                return
            self._bytes += size
            self._waiting.append((message, wall_ns()))

    def take(self) -> list[Raw]:
        """Everything that waits, oldest first."""
        with self._lock:
            taken, self._waiting = self._waiting, deque()
            self._bytes = 0
        return [self._read(message, at_ns) for message, at_ns in taken]
