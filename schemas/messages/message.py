"""Base class of every message."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, TypeVar


class Message:
    """A typed value on the bus; subclasses are frozen dataclasses.

    Attributes:
      ROS_TYPE: The standard ROS 2 type that carries the message; empty: a type of our own, `tailor_msgs/msg/<name>`.
      ROS_PACKAGE: ROS 2 package of a type that is not standard; a robot's package has its own.
      FRAME_ID: The frame in the header of a type of our own.
    """

    __slots__ = ()

    ROS_TYPE: ClassVar[str] = ""
    ROS_PACKAGE: ClassVar[str] = "tailor_msgs"
    FRAME_ID: ClassVar[str] = ""


AnyMessage = TypeVar("AnyMessage", bound=Message)


def stamped(message: AnyMessage, stamp_ns: int) -> AnyMessage:
    """The message with this stamp; one of a type without stamps as it is."""
    copied: Any = message
    return replace(copied, stamp_ns=stamp_ns) if hasattr(message, "stamp_ns") else message
