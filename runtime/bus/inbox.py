"""What has arrived since the last look: newest sample per state topic, every one of an event topic (up to a bound).

Polled from the loop's own thread; no callbacks. Bytes that cannot be used are counted by key and reason.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from tailor.runtime.bus.arrival import Instant, arrival_ns
from tailor.runtime.bus.attachment import unpack
from tailor.runtime.clock import wall_ns
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Sample
from tailor.schemas.topics import Topic

EVENT_DEPTH = 16  # event topics and commands: more than one in a tick, e.g. two people who arm, or a foreign command


@dataclass(frozen=True, slots=True)
class Raw:
    """One publication as it came off the bus."""

    key: str
    payload: bytes
    attachment: bytes | None
    encoding: str
    is_put: bool  # false for zenoh's delete
    received_wall_ns: int | None


class Source(Protocol):
    """One subscription; session.py makes it of a zenoh subscriber with a ring handler."""

    def receive(self) -> Raw | None:
        """The oldest sample that waits, None if there is none; never blocks."""
        ...


def depth(topic: Topic) -> int:
    """How many samples of a topic to keep between two looks: states replace each other, events and commands do not."""
    return 1 if topic.rate_hz > 0 and topic.priority != "real_time" else EVENT_DEPTH


class Inbox:
    """Subscriptions of one process that are drained once a tick."""

    def __init__(
        self,
        rows: Sequence[tuple[Topic, str, Source]],  # topic, its key, where its samples come from
        encodings: Callable[[type], str],
        now: Callable[[], int],
        wall: Callable[[], int] = wall_ns,
    ) -> None:
        self.rejected: Counter[tuple[str, str]] = Counter()  # (key, reason) -> how many
        self._rows = [(topic, key, source, encodings(topic.type)) for topic, key, source in rows]
        self._now, self._wall = now, wall
        self._previous = Instant(now(), wall())
        self._last: dict[str, tuple[str, int]] = {}  # sender and number of the newest message, by key

    def drain(self, now_ns: int | None = None) -> tuple[Sample, ...]:
        """All new samples, oldest first, none of them stamped as arriving after `now_ns` (default: now)."""
        now = Instant(self._now() if now_ns is None else now_ns, self._wall())
        samples = []
        for topic, key, source, encoding in self._rows:
            for _ in range(EVENT_DEPTH):  # bounded, whatever a flood brings
                raw = source.receive()
                if raw is None:
                    break
                found = self._read(topic, key, encoding, raw, now)
                if isinstance(found, Rejected):
                    self.rejected[key, found.reason] += 1
                else:
                    samples.append(found)
        self._previous = now
        return tuple(sorted(samples, key=lambda sample: sample.arrival_ns))

    def _read(self, topic: Topic, key: str, encoding: str, raw: Raw, now: Instant) -> Sample | Rejected:
        if raw.key != key:
            return Rejected("other key")  # a put on a wildcard reaches every key that it covers
        if not raw.is_put:
            return Rejected("not a put")
        if raw.encoding.startswith("application/cdr;") and raw.encoding != encoding:
            return Rejected("other type")
        origin = unpack(raw.attachment)
        if isinstance(origin, Rejected):
            return origin
        if origin.sequence and self._last.get(key) == (origin.sender, origin.sequence):
            return Rejected("repeated")  # a frozen sender is heard no more, and so its topic gets stale
        message = decode(topic, raw.payload)
        if isinstance(message, Rejected):
            return message
        self._last[key] = (origin.sender, origin.sequence)
        arrived = arrival_ns(raw.received_wall_ns, self._previous, now)
        return Sample(key, message, arrived, origin.sequence, origin.sender)
