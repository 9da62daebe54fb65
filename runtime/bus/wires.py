"""What zenoh's publishers and subscribers carry, in the words of the rest of the bus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import zenoh

from tailor.runtime.bus.inbox import EVENT_DEPTH, Raw
from tailor.runtime.bus.ros_wires import as_plain
from tailor.schemas.ros2.profiles import KeyProfile

MAX_PLAIN_BYTES = 1 << 20  # of a topic that is none of ours
MAX_ATTACHMENT_BYTES = 255  # those that mean anything have 33; queues count a message by its payload


class Subscriptions:
    """Subscriptions that end together."""

    def __init__(self, declared: Sequence[Any]) -> None:
        self._declared = declared

    def undeclare(self) -> None:
        """End them."""
        for each in self._declared:
            each.undeclare()


class Wire:
    """What a Publisher puts its messages on: publishers of one topic under all its keys."""

    def __init__(self, publishers: Sequence[zenoh.Publisher]) -> None:
        self._publishers = publishers
        builder = zenoh.TimestampInstrumentationBuilder()  # "unstable" in zenoh 1.x; used by arrival.py
        self._note_reception = builder.set_receive(True).build()

    def put(self, payload: bytes, attachment: bytes | None) -> None:
        """Publish under every key."""
        for publisher in self._publishers:
            publisher.put(payload, attachment=attachment, timestamp_instrumentation=self._note_reception)

    def matched(self) -> bool:
        """Whether anybody listens under any of the keys."""
        return any(_status(publisher).matching for publisher in self._publishers)


def _status(publisher: Any) -> Any:
    return publisher.matching_status  # its type hint is wrong: the value is a MatchingStatus


class RingSource:
    """The newest few messages under one key."""

    def __init__(self, subscriber: Any, keys: KeyProfile, max_bytes: int) -> None:
        self._subscriber, self._keys, self._max_bytes = subscriber, keys, max_bytes

    def receive(self) -> Raw | None:
        """The oldest of them that is one of ours, with its plain key; None if there is none."""
        for _ in range(EVENT_DEPTH):  # a flood of copies, none of which is returned, would have no end
            sample = self._subscriber.try_recv()
            raw = None if sample is None else as_plain(raw_of(sample, self._max_bytes), self._keys)
            if sample is None or raw is not None:
                return raw
        return None


def raw_of(sample: zenoh.Sample, max_bytes: int | None = None) -> Raw:
    """Copy of a sample: one that waits would pin the whole batch in which it came.

    Of a payload above `max_bytes` only that much, and one byte, of zeros is made: whoever decodes it judges the length
    first. Copying 200 MB takes a tick. So it is with an attachment that is none of ours.
    """
    attachment, payload = sample.attachment, sample.payload
    return Raw(
        key=str(sample.key_expr),
        payload=payload.to_bytes() if max_bytes is None else _bounded(payload, max_bytes),
        attachment=None if attachment is None else _bounded(attachment, MAX_ATTACHMENT_BYTES),
        encoding=str(sample.encoding),
        is_put=sample.kind == zenoh.SampleKind.PUT,
        received_wall_ns=_reception_stamp(sample),
    )


def _bounded(part: Any, most: int) -> bytes:
    return bytes(most + 1) if len(part) > most else part.to_bytes()


def received_raw(sample: zenoh.Sample, at_ns: int) -> Raw:
    """Copy of a sample, received at the latest at `at_ns`, the present wall time.

    zenoh's clock never goes back: where the wall clock has been set back, its stamps stand still until that catches up.
    """
    raw = raw_of(sample)
    stamped_ns = at_ns if raw.received_wall_ns is None else raw.received_wall_ns
    return replace(raw, received_wall_ns=min(stamped_ns, at_ns))


def _reception_stamp(sample: zenoh.Sample) -> int | None:
    stack = sample.timestamp_stack
    records = stack.records if stack is not None else []
    if not records or records[-1].point != zenoh.InterceptionPoint.RECEIVE or records[-1].is_custom:
        return None
    fixed_point = int(str(records[-1].timestamp()).split("/", 1)[0])  # NTP64: seconds and a 32-bit fraction
    return (fixed_point >> 32) * 1_000_000_000 + ((fixed_point & 0xFFFFFFFF) * 1_000_000_000 >> 32)
