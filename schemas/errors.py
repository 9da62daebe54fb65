"""Errors from outside: unusable input of a user, and refused messages."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class UsageError(Exception):
    """Unusable input of a user; the message states in one line what, where and what was expected.

    `tailor` prints it without a traceback and exits with code 2; nothing has been started by then.
    """


class UnreachableError(UsageError):
    """What another process provides is not there yet or any more, e.g. the bus: trying again later may help."""


@dataclass(frozen=True, slots=True)
class Rejected:
    """A refused input; a value, never an exception. Decoding refuses with the reasons of `DecodeRefusal`."""

    reason: str
    where: str = field(default="", compare=False)  # field of a message, if known; refusals are counted by the reason

    @property
    def text(self) -> str:
        """The reason for people, with the field."""
        return f"{self.reason} ({self.where})" if self.where else self.reason


class DecodeRefusal(StrEnum):
    """Reason for refusing the bytes of a message; few, so that they can be counted."""

    TOO_LONG = "too long"
    MALFORMED = "malformed"
    TRAILING_BYTES = "trailing bytes"
    NOT_FINITE = "not finite"
    TOO_LARGE = "number too large"
    NEGATIVE_VARIANCE = "negative variance"
    STAMP_OUT_OF_RANGE = "stamp out of range"
    NO_UNIT_QUATERNION = "orientation is not a unit quaternion"
    JOINT_LACKS_VALUE = "a joint lacks a value"


class RefusedValueError(ValueError):
    """A value inside a message is refused; raised and caught inside the codec.

    Attributes:
      reason: The reason that gets counted.
    """

    def __init__(self, reason: DecodeRefusal) -> None:
        super().__init__(reason.value)
        self.reason = reason
