"""Keeps the first valid e-stop between two polls, whatever floods the key: decided on arrival, not in a ring."""

from __future__ import annotations

from tailor.runtime.bus.inbox import Raw
from tailor.schemas.codec import decode
from tailor.schemas.messages import EStop
from tailor.schemas.topics import Topic


class EStopLatch:
    """The source of an inbox row for the e-stop topic; `offer` runs in the bus's thread, `receive` in the loop's."""

    def __init__(self, topic: Topic, key: str) -> None:
        """Empty."""
        self._topic, self._key = topic, key
        self._latched: Raw | None = None

    def offer(self, raw: Raw) -> None:
        """Keep a request to stop; releases, other keys and malformed bytes leave no trace."""
        if self._latched is None and raw.is_put and raw.key == self._key:
            message = decode(self._topic, raw.payload)
            if isinstance(message, EStop) and message.stop:
                self._latched = raw

    def receive(self) -> Raw | None:
        """The request to stop since the last call, if there was one."""
        raw = self._latched
        if raw is not None:  # else a stop that is offered at this moment would be erased unread
            self._latched = None
        return raw
