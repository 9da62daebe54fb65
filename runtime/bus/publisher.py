"""Sends the messages of one topic, numbered and signed; never waits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.clock import wall_ns
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message


class Wire(Protocol):
    """Where the bytes go; session.py makes it of a zenoh publisher."""

    def put(self, payload: bytes, attachment: bytes | None) -> None:
        """Hand over one publication; drop it rather than wait."""
        ...

    def matched(self) -> bool:
        """Whether anyone listens."""
        ...


class Publisher:
    """One topic's outlet of one process; `key` is where it publishes."""

    def __init__(self, key: str, wire: Wire, sender: str, wall: Callable[[], int] = wall_ns) -> None:
        self.key = key
        self.sequence = 0  # of the message sent last
        self._wire = wire
        self._sender = sender
        self._wall = wall

    def publish(self, message: Message) -> int:
        """Send a message under the next sequence number, from 1, and return that number."""
        self.sequence += 1
        self.put_raw(encode(message), Origin(self.sequence, self._wall(), self._sender))
        return self.sequence

    def put_raw(self, payload: bytes, origin: Origin) -> None:
        """Send bytes that were recorded, under the number and sender that they had; an unsigned one stays unsigned."""
        self._wire.put(payload, pack(origin) if origin.sender else None)

    def matched(self) -> bool:
        """Whether anyone listens; players and start-up wait for it."""
        return self._wire.matched()
