"""Keeps e-stops between two polls, whatever floods their key: decided on arrival, not in a ring.

Of the requests to stop it keeps the first, of the held dead man's switches the newest message of each sender.
"""

from __future__ import annotations

from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw, origin_of
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import EStop
from tailor.schemas.topics import Topic

MAX_SENDERS = 32  # of held switches between two polls


class EStopLatch:
    """The source of an inbox row for the e-stop topic; `offer` runs in the bus's thread, `receive` in the loop's."""

    def __init__(self, topic: Topic, key: str) -> None:
        """Empty."""
        self._topic, self._key = topic, key
        self._encoding = encoding_of(topic.type)
        self._latched: Raw | None = None
        self._held: dict[str, Raw] = {}  # by sender; filled by the bus's thread, which never waits for the loop's
        self._waiting: list[Raw] = []  # taken out of it by the loop's thread
        self._overflowed = False

    def offer(self, raw: Raw) -> None:
        """Keep a message if it is the first request to stop or the newest of a held switch.

        Only a message that the inbox accepts is kept, or junk would keep the place of a request to stop.
        """
        origin = origin_of(raw, self._key, self._encoding)
        if isinstance(origin, Rejected) or not isinstance(message := decode(self._topic, raw.payload), EStop):
            return
        if message.stop:
            self._latched = self._latched or raw
        elif origin.sender in self._held or len(self._held) < MAX_SENDERS:
            self._held[origin.sender] = raw
        else:
            self._overflowed = True

    def receive(self) -> Raw | Rejected | None:
        """The request to stop since the last call, else the next message of a held switch."""
        raw = self._latched
        if raw is not None:  # else a stop that is offered at this moment would be erased unread
            self._latched = None
            return raw
        if self._overflowed:
            self._overflowed = False
            return Rejected("too many senders")
        if not self._waiting and self._held:
            held, self._held = self._held, {}
            self._waiting = list(held.values())  # one that is offered at this moment may be lost; it is repeated
        return self._waiting.pop(0) if self._waiting else None
