"""The way to a driver, and what is heard of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from tailor.runtime.bus.attachment import Origin
from tailor.schemas.messages import Message


@dataclass(frozen=True, slots=True)
class Heard:
    """A message of the driver.

    Attributes:
      at_s: When it was received.
      stamp_s: When it was measured, by the driver's clock; `at_s` for a message without a stamp.
    """

    at_s: float
    stamp_s: float
    topic: str
    message: Message
    frame: str
    sender: str
    sequence: int


class Link(Protocol):
    """The way to a driver."""

    def now_s(self) -> float:
        """Time of this link, seconds."""
        ...

    def wall_s(self, at_s: float) -> float:
        """Time by the clock of stamps, seconds, at a time of this link."""
        ...

    def wait(self, seconds: float) -> list[Heard]:
        """Let time pass; what was heard meanwhile."""
        ...

    def publish(self, topic: str, message: Message, origin: Origin) -> None:
        """Publish to the driver, with any origin."""
        ...

    def stalled_s(self) -> float:
        """Longest time, since the last call, for which this process could not run when it had to."""
        ...


def speed_in(heard: Heard, axis: str) -> float | None:
    """Speed of an axis in a message: of a joint by its name, or the field of the axis's name beside a position."""
    message = heard.message
    names = getattr(message, "names", None)
    velocities = getattr(message, "velocities", ())
    if names is not None:
        return dict(zip(names, velocities, strict=False)).get(axis)
    value = getattr(message, axis, None)
    return value if isinstance(value, float) else None
