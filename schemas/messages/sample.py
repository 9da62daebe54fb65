"""A message as it arrived."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class Sample:
    """A received message with its sender, sequence number and time of arrival."""

    key: str
    message: Message
    arrival_ns: int  # receiver's monotonic clock
    sequence: int  # counted by the sender
    sender: str = ""  # 32 hex digits
