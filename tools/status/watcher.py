"""Feeds a model of the system from the bus; of a flood it reads a part, so that the stop key stays quick."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from tailor.runtime.bus.arrival import Instant, arrival_ns
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import wall_ns
from tailor.tools.status.system_model import SystemModel

MAX_OF_KEY = 50  # read in one poll; the fastest topic has 13 in 0.25 s
MAX_READ = 500  # of all keys; takes less than 50 ms


class Watcher:
    """Moves publications from the queue of a subscription into a model."""

    def __init__(self, queue: IngestQueue, model: SystemModel, now_ns: int, wall: Callable[[], int] = wall_ns) -> None:
        """`now_ns`: monotonic time; `wall`: Unix nanoseconds, for the stamps of reception."""
        self._queue, self._model, self._wall = queue, model, wall
        self._previous = Instant(now_ns, wall())
        self._unread = 0

    def poll(self, now_ns: int) -> None:
        """Take the publications since the last call; none counts as later than `now_ns`."""
        now = Instant(now_ns, self._wall())
        taken: Counter[str] = Counter()
        total = 0
        for raw in self._queue.drain():
            if taken[raw.key] >= MAX_OF_KEY or total >= MAX_READ:
                self._unread += 1
                continue
            taken[raw.key] += 1
            total += 1
            self._model.take(raw, arrival_ns(raw.received_wall_ns, self._previous, now))
        self._model.foreign.dropped = self._unread + self._queue.drops.total()
        self._previous = now
