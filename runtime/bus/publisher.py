"""Publisher of one topic: numbered messages with a sender id; never waits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.clock import wall_ns
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message


class Wire(Protocol):
    """Destination of the bytes; wires.py implements it with zenoh publishers."""

    def put(self, payload: bytes, attachment: bytes | None) -> None:
        """Send one publication; drop it rather than wait."""
        ...

    def matched(self) -> bool:
        """Whether there is a subscriber."""
        ...


class Publisher:
    """Publisher of one process under one key."""

    def __init__(self, key: str, wire: Wire, sender: str, wall: Callable[[], int] = wall_ns) -> None:
        self.key = key
        self.sequence = 0  # of the last message
        self._wire = wire
        self._sender = sender
        self._wall = wall

    def publish(self, message: Message) -> int:
        """Publish a message under the next sequence number, from 1; returns the number."""
        return self.publish_encoded(encode(message))

    def publish_encoded(self, payload: bytes) -> int:
        """Publish the CDR bytes of a message of ours under the next sequence number; returns the number."""
        self.sequence += 1
        self.put_raw(payload, Origin(self.sequence, self._wall(), self._sender))
        return self.sequence

    def put_raw(self, payload: bytes, origin: Origin) -> None:
        """Publish recorded bytes with their original origin; an unsigned message stays unsigned."""
        self._wire.put(payload, pack(origin) if origin.sender else None)

    def matched(self) -> bool:
        """Whether there is a subscriber; players and start-up wait for one."""
        return self._wire.matched()
