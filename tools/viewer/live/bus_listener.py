"""Converts the messages of a running system into events.

The listener is a plain subscriber with its own queue. It publishes nothing and delays no other node.
"""

from __future__ import annotations

from collections.abc import Callable

from tailor.runtime.bus.arrival import Instant, arrival_ns
from tailor.runtime.bus.attachment import unpack
from tailor.runtime.bus.inbox import Raw, message_of
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import Clock, wall_ns
from tailor.runtime.loop import Loop
from tailor.schemas.errors import Rejected
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.timed_messages import EXECUTIVE
from tailor.tools.viewer.timeline import Event, RunTimeline

POLL_NS = 50_000_000  # 20 updates of the page a second
BEAT_NS = 500_000_000  # between beats; pages take three seconds without one for a viewer that hangs


class BusListener:
    """Converts received messages into events.

    Args:
      intake: Filled by the bus's thread.
      timeline: State of the conversion.
      broadcast: Receives the events.
      sender: Leave out executives whose id does not begin with this.
      now_ns: Monotonic time.
      wall: Unix nanoseconds, for the stamps of reception.
      connected: Whether the bus is connected.
    """

    def __init__(
        self,
        intake: IngestQueue,
        timeline: RunTimeline,
        broadcast: EventBroadcast,
        sender: str,
        now_ns: int,
        wall: Callable[[], int] = wall_ns,
        connected: Callable[[], bool] = lambda: True,
    ) -> None:
        self._intake = intake
        self._timeline = timeline
        self._broadcast = broadcast
        self._sender = sender
        self._began_ns: int | None = None
        self._wall = wall
        self._connected = connected
        self._beat_ns = now_ns - BEAT_NS
        self._previous = Instant(now_ns, wall())

    def poll(self, now_ns: int) -> None:
        """Convert and broadcast the messages received since the last call; none counts as later than `now_ns`."""
        events: list[Event] = []
        now = Instant(now_ns, self._wall())
        for raw in self._intake.drain():
            message = message_of(raw) if self._wanted(raw) else None
            if message is not None:
                events += self._timeline.events_of(self._at_s(raw, now), raw.key, message)
        self._previous = now
        now_s = 0.0 if self._began_ns is None else (now_ns - self._began_ns) / 1e9
        self._broadcast.publish(events + self._timeline.silences(now_s))
        if now_ns - self._beat_ns >= BEAT_NS:
            self._beat_ns = now_ns
            self._broadcast.beat(now_s, self._connected())

    def run(self, clock: Clock, stopped: Callable[[], bool]) -> None:
        """Poll periodically until `stopped` returns True."""
        loop = Loop(POLL_NS, clock)
        while not stopped():
            loop.wait_for_next_period()
            self.poll(clock.now_ns())

    def _at_s(self, raw: Raw, now: Instant) -> float:
        """Seconds since the arrival of the first message, by the clock that never goes back."""
        arrived_ns = arrival_ns(raw.received_wall_ns, self._previous, now)
        self._began_ns = arrived_ns if self._began_ns is None else self._began_ns
        return max(0.0, (arrived_ns - self._began_ns) / 1e9)

    def _wanted(self, raw: Raw) -> bool:
        if not self._sender or not raw.key.startswith(EXECUTIVE):
            return True
        origin = unpack(raw.attachment)
        return not isinstance(origin, Rejected) and origin.sender.startswith(self._sender)
