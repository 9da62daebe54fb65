"""Sender ids that the launcher gives its children: by them it knows their messages from those of strangers."""

from __future__ import annotations

import secrets

from tailor.runtime.bus.attachment import SENDER_BYTES
from tailor.schemas.messages import Sample


class Senders:
    """A new id for each start of each child.

    Attributes:
      leave: Id of the first executive, which a driver must know before that executive starts.
    """

    def __init__(self) -> None:
        self.leave = secrets.token_hex(SENDER_BYTES)
        self._current: dict[str, str] = {}

    def arguments(self, name: str, start: int) -> tuple[str, ...]:
        """Arguments that hand a child its id for its n-th start, from 1 on; its earlier ids count no more."""
        first_executive = name == "executive" and start == 1
        self._current[name] = self.leave if first_executive else secrets.token_hex(SENDER_BYTES)
        return ("--sender", self._current[name])

    def of(self, name: str) -> str:
        """Id of the current child of that name; "" before its first start."""
        return self._current.get(name, "")

    def sent(self, sample: Sample, name: str) -> bool:
        """Whether a message comes from the current child of that name."""
        return bool(sample.sender) and sample.sender == self._current.get(name)
