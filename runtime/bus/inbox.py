"""Samples since the last drain: of a state topic each sender's newest, of an event topic all (up to a bound).

Drained from the loop's own thread, without callbacks. Rejected samples are counted by key and reason.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from tailor.runtime.bus.arrival import Instant, arrival_ns
from tailor.runtime.bus.attachment import Origin, unpack
from tailor.runtime.bus.encoding import encoding_of, is_of_other_type, named_type
from tailor.runtime.clock import wall_ns
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import EStop, Message, Sample
from tailor.schemas.topics import Topic
from tailor.schemas.typesystem import type_of

MAX_SENDERS = 32  # of a topic, whose newest sequence numbers are remembered
EVENT_DEPTH = 16  # events and commands may come several in a tick, e.g. two arming requests


@dataclass(frozen=True, slots=True)
class Raw:
    """One publication as received, not yet decoded."""

    key: str
    payload: bytes
    attachment: bytes | None
    encoding: str
    is_put: bool  # False for zenoh's delete
    received_wall_ns: int | None


def message_of(raw: Raw) -> Message | None:
    """The message of a publication, by the type that it names; None for a delete, and for foreign and damaged ones."""
    kind = type_of(named_type(raw.encoding))
    if kind is None or not raw.is_put:
        return None
    message = decode(kind, raw.payload)
    return None if isinstance(message, Rejected) else message


class Source(Protocol):
    """One subscription; wires.py implements it with a zenoh ring buffer, latch.py for e-stops."""

    def receive(self) -> Raw | Rejected | None:
        """Oldest waiting sample, or why one was dropped; None if there is none; never blocks."""
        ...


def is_state(topic: Topic) -> bool:
    """True if a newer sample replaces an older one; events and commands do not replace each other."""
    return topic.rate_hz > 0 and topic.priority != "real_time"


class Inbox:
    """Subscriptions of one process, drained once a tick."""

    def __init__(
        self,
        subscriptions: Sequence[tuple[Topic, str, Source]],  # topic, its key, source of its samples
        now: Callable[[], int],
        wall: Callable[[], int] = wall_ns,
        newest_only: bool = False,  # of a state topic, each sender's newest valid sample alone
    ) -> None:
        self.rejected: Counter[tuple[str, str]] = Counter()  # (key, reason) -> count
        self.refused_fields: dict[str, str] = {}  # key -> what was wrong with which field, of one of the last
        self._subscriptions = [(topic, key, source, encoding_of(topic.type)) for topic, key, source in subscriptions]
        self._now, self._wall, self._newest_only = now, wall, newest_only
        self._previous = Instant(now(), wall())
        self._last: dict[int, dict[str, int]] = {}  # sequence number of each sender's newest message, by subscription

    def drain(self, now_ns: int | None = None) -> tuple[Sample, ...]:
        """All new samples, ordered by arrival; no arrival is later than `now_ns` (default: now)."""
        now = Instant(self._now() if now_ns is None else now_ns, self._wall())
        samples = []
        for number, (topic, key, source, _) in enumerate(self._subscriptions):
            newest_only = self._newest_only and is_state(topic)
            waiting, complete = _received(source), set[str]()  # senders whose newest valid sample is known
            for raw in reversed(waiting) if newest_only else waiting:
                sample = raw if isinstance(raw, Rejected) else self._read(number, raw, now, complete)
                if sample is None:
                    continue
                if isinstance(sample, Rejected):
                    self.rejected[key, sample.reason] += 1
                    if sample.where:
                        self.refused_fields[key] = sample.text
                    continue
                samples.append(sample)
                if newest_only:  # no invalid sample, and none of a stranger, replaces a valid one
                    complete.add(sample.sender)
        self._previous = now
        return tuple(sorted(samples, key=lambda each: each.arrival_ns))

    def _read(self, number: int, raw: Raw, now: Instant, complete: set[str]) -> Sample | Rejected | None:
        """The sample; None if it comes from one of the `complete` senders."""
        topic, key, _, encoding = self._subscriptions[number]
        origin = origin_of(raw, key, encoding)
        if isinstance(origin, Rejected):
            return origin
        if origin.sender in complete:
            return None
        last = self._last.setdefault(number, {})
        repeated = origin.sequence and last.get(origin.sender) == origin.sequence
        if repeated:
            last[origin.sender] = last.pop(origin.sender)  # a frozen sender is not a silent one
        if repeated and topic.type is not EStop:  # a forged repetition must not take the place of an e-stop
            return Rejected("repeated")  # repeats of a frozen sender are ignored, so its topic becomes stale
        message = decode(topic, raw.payload)
        if isinstance(message, Rejected):
            return message
        if last.pop(origin.sender, None) is None and len(last) == MAX_SENDERS:
            del last[next(iter(last))]  # the one that has been silent longest
        last[origin.sender] = origin.sequence
        arrived = arrival_ns(raw.received_wall_ns, self._previous, now)
        return Sample(key, message, arrived, origin.sequence, origin.sender)


def origin_of(raw: Raw, key: str, encoding: str) -> Origin | Rejected:
    """Origin of a message for a subscription to a key, whose messages have this encoding."""
    if raw.key != key:
        return Rejected("other key")  # a put on a wildcard reaches every key that matches
    if not raw.is_put:
        return Rejected("not a put")
    if is_of_other_type(raw.encoding, encoding):
        return Rejected("other type")
    return unpack(raw.attachment)


def _received(source: Source) -> list[Raw | Rejected]:
    """Waiting samples, oldest first; at most EVENT_DEPTH, also during a flood."""
    waiting: list[Raw | Rejected] = []
    while len(waiting) < EVENT_DEPTH and (raw := source.receive()) is not None:
        waiting.append(raw)
    return waiting


def by_reason(rejected: Mapping[tuple[str, str], int]) -> Counter[str]:
    """How many messages an inbox has rejected for each reason, under all keys."""
    counts: Counter[str] = Counter()
    for (_, reason), count in rejected.items():
        counts[reason] += count
    return counts
