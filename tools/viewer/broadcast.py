"""Rows from one writer to any number of pages: newcomers get what is kept, the slow ones are let go and come again."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from queue import Empty, Full, Queue
from threading import Lock

from tailor.tools.viewer.timeline import Event

KEEP_S = 600.0  # of what comes at a rate; events are kept from the start
WAITING = 64  # batches, six seconds, that a page may lag behind
AT_A_RATE = {"tick", "belief", "truth", "believed", "seen", "odom"}


class Subscription:
    """What one page has still to be told."""

    def __init__(self, kept: str) -> None:
        self.lost = False
        self._waiting: Queue[str] = Queue(WAITING)
        self._waiting.put(kept)

    def put(self, batch: str) -> None:
        """Add a batch, unless the page has fallen too far behind."""
        try:
            self._waiting.put_nowait(batch)
        except Full:
            self.lost = True

    def let_go(self) -> None:
        """Wake whoever waits for a batch, to find that there will be no more."""
        self.lost = True
        self.put("[]")

    def next(self, timeout_s: float) -> str | None:
        """The next batch, a JSON array of rows; None when there is none in time."""
        try:
            return self._waiting.get(timeout=timeout_s)
        except Empty:
            return None


class EventBroadcast:
    """Keeps the run so far and hands on what comes."""

    def __init__(self, keep_s: float = KEEP_S) -> None:
        self._keep_s = keep_s
        self._rows: list[Event] = []
        self._pages: set[Subscription] = set()
        self._lock = Lock()
        self.closed = False

    @property
    def pages(self) -> int:
        """How many pages listen."""
        return len(self._pages)

    def publish(self, rows: Sequence[Event]) -> None:
        """Hand rows to every page; never waits for one."""
        if not rows:
            return
        batch = encoded(rows)
        with self._lock:
            self._rows.extend(rows)
            self._forget(rows[-1].at_s)
            for page in self._pages:
                page.put(batch)

    def close(self) -> None:
        """Let every page go, and take no more."""
        with self._lock:
            self.closed = True
            for page in self._pages:
                page.let_go()

    @contextmanager
    def subscribe(self) -> Iterator[Subscription]:
        """A page that listens as long as this lasts, beginning with all that is kept."""
        with self._lock:
            page = Subscription(encoded(self._rows))
            self._pages.add(page)
        try:
            yield page
        finally:
            with self._lock:
                self._pages.discard(page)

    def _forget(self, now_s: float) -> None:
        """Drop what came at a rate and is old, a minute at a time."""
        if self._rows[0].at_s >= now_s - self._keep_s - 60:
            return
        oldest = now_s - self._keep_s
        kept = [row for row in self._rows if row.at_s >= oldest or not _at_a_rate(row)]
        self._rows = kept


def encoded(rows: Sequence[Event]) -> str:
    """Rows as one line of JSON."""
    return json.dumps([row.json_value() for row in rows], allow_nan=False, separators=(",", ":"))


def _at_a_rate(row: Event) -> bool:
    return row.kind in AT_A_RATE or row.kind.startswith("series ")
