"""A running system into rows: a plain subscriber with its own queue, that publishes nothing and delays nobody."""

from __future__ import annotations

from collections.abc import Callable

from tailor.runtime.bus.attachment import unpack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import Clock, wall_ns
from tailor.runtime.loop import Loop
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.schemas.typesystem import type_of
from tailor.tools.viewer.broadcast import EventBroadcast
from tailor.tools.viewer.recorded_messages import EXECUTIVE
from tailor.tools.viewer.timeline import Event, RunTimeline

LOOK_NS = 50_000_000  # so often the page moves
ENCODING = "application/cdr;"


class BusListener:
    """Turns what has arrived into rows.

    Args:
      intake: Filled by the bus's thread.
      story: Keeps what has been told.
      feed: Where the rows go.
      sender: Leave out executives whose id does not begin with this.
    """

    def __init__(self, intake: IngestQueue, story: RunTimeline, feed: EventBroadcast, sender: str = "") -> None:
        self._intake = intake
        self._story = story
        self._feed = feed
        self._sender = sender
        self._began_ns: int | None = None

    def look(self) -> None:
        """Take what has arrived and hand it on."""
        rows: list[Event] = []
        for raw in self._intake.drain():
            message = _read(raw)
            if message is not None and self._wanted(raw):
                rows += self._story.tell(self._at_s(raw), raw.key, message)
        self._feed.publish(rows)

    def run(self, clock: Clock, stopped: Callable[[], bool]) -> None:
        """Look until told to stop."""
        loop = Loop(LOOK_NS, clock)
        while not stopped():
            loop.wait_for_next_period()
            self.look()

    def _at_s(self, raw: Raw) -> float:
        """Seconds since the first message was received, by the wall clock that recordings have too."""
        received_ns = raw.received_wall_ns or wall_ns()
        self._began_ns = received_ns if self._began_ns is None else self._began_ns
        return max(0.0, (received_ns - self._began_ns) / 1e9)

    def _wanted(self, raw: Raw) -> bool:
        if not self._sender or not raw.key.startswith(EXECUTIVE):
            return True
        origin = unpack(raw.attachment)
        return not isinstance(origin, Rejected) and origin.sender.startswith(self._sender)


def _read(raw: Raw) -> Message | None:
    """The value of a publication of our types; None for others, and for what is damaged."""
    kind = type_of(raw.encoding.removeprefix(ENCODING))
    if kind is None or not raw.is_put:
        return None
    message = decode(kind, raw.payload)
    return None if isinstance(message, Rejected) else message
