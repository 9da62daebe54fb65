"""Broadcasts events to any number of pages.

A new page receives the kept events first. A page that falls behind is disconnected and connects again.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Lock

from tailor.tools.viewer.columns import compact_json
from tailor.tools.viewer.live.subscription import Subscription
from tailor.tools.viewer.timeline import Event, is_sample

KEEP_S = 600.0  # of everything. The page keeps as much (run.js)
KEEP_EVENTS = 2000  # the newest of each kind that are older, except of what passes: hours of plans, actions and states
WHY = "why"  # kind of the alternatives of a decision: curves, a hundred times as large as the decision itself
MAX_RECENT = 20_000  # of each kind, the newest: three times those of KEEP_S at 10 Hz; a flood has more
BEAT = "now"  # kind of an event that is not kept
OUTLINE = "outline "  # starts the kinds of outlines, which a moving arm sends as often as samples; the newest is kept


@dataclass(frozen=True, slots=True)
class _Kept:
    """An event as it was sent: for a new page the whole run is joined, while the stop button waits."""

    at_s: float
    kind: str
    text: str


class TooManyPagesError(Exception):
    """As many pages are connected as may be."""


class EventBroadcast:
    """Keeps the events of a run and passes new ones to all pages. Thread-safe."""

    def __init__(self, keep_s: float = KEEP_S) -> None:
        self._keep_s, self._forgot_s = keep_s, 0.0
        self._events: list[_Kept] = []
        self._pages: set[Subscription] = set()
        self._lock = Lock()
        self.closed = False

    @property
    def pages(self) -> int:
        """Number of connected pages."""
        return len(self._pages)

    def publish(self, events: Sequence[Event]) -> None:
        """Pass events to every page without waiting for one."""
        if not events:
            return
        kept = [_Kept(event.at_s, event.kind, compact_json(event.json_value())) for event in events]
        batch = _joined(kept)
        with self._lock:
            self._events.extend(kept)
            self._forget(events[-1].at_s)
            for page in self._pages:
                page.put(batch)

    def beat(self, at_s: float, bus: bool) -> None:
        """Send every page a sign of life; a page that receives none for seconds shows that it is not live.

        Args:
          at_s: Now, seconds on the time axis of the run.
          bus: Whether the viewer is connected to the bus.
        """
        batch = compact_json([Event(at_s, BEAT, {"bus": bus}).json_value()])
        with self._lock:
            for page in self._pages:
                page.put(batch)

    def restart(self) -> None:
        """Forget the run, and disconnect all pages; they connect again."""
        with self._lock:
            self._events, self._forgot_s = [], 0.0
            for page in self._pages:
                page.close()

    def close(self) -> None:
        """Disconnect all pages and accept no more."""
        with self._lock:
            self.closed = True
            for page in self._pages:
                page.close()

    @contextmanager
    def subscribe(self, most: int | None = None) -> Iterator[Subscription]:
        """Connect a page for the duration of the context; its first batch holds all kept events.

        Args:
          most: Pages at a time; None: any number.

        Raises:
          TooManyPagesError: So many are connected already.
        """
        with self._lock:
            if most is not None and self.pages >= most:
                raise TooManyPagesError
            page = Subscription(_joined(self._events))
            self._pages.add(page)
        try:
            yield page
        finally:
            with self._lock:
                self._pages.discard(page)

    def _forget(self, now_s: float) -> None:
        """Drop what has passed, a minute at a time."""
        if now_s < self._forgot_s + 60:
            return
        self._forgot_s, oldest = now_s, now_s - self._keep_s
        kept, numbers = list[_Kept](), Counter[str]()
        for event in reversed(self._events):
            numbers[event.kind] += 1
            if numbers[event.kind] <= (MAX_RECENT if event.at_s >= oldest else _kept_of(event.kind)):
                kept.append(event)
        self._events = kept[::-1]


def _joined(events: Sequence[_Kept]) -> str:
    """Events as one line of JSON."""
    return f"[{','.join(event.text for event in events)}]"


def _kept_of(kind: str) -> int:
    """Number of events of a kind that are kept however old they are."""
    if is_sample(kind):
        return 0
    return 1 if kind == WHY or kind.startswith(OUTLINE) else KEEP_EVENTS
