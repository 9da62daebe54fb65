"""Converts stamps: integer nanoseconds in our messages, `std_msgs/Header` in ROS.

Every stamped message carries a whole header, because viewers plot over `header.stamp` and read the frame from it.
ROS's seconds have 31 bits. After 2038, or where a clock is set to then by mistake, stamps begin again at 1970.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from tailor.schemas.errors import DecodeRefusal, RefusedValueError
from tailor.schemas.typesystem import ros_class

NS_PER_S = 1_000_000_000
MAX_STAMP_NS = 2**31 * NS_PER_S - 1  # builtin_interfaces/Time holds int32 seconds


@cache
def _classes() -> tuple[Any, Any]:
    return ros_class("std_msgs/msg/Header"), ros_class("builtin_interfaces/msg/Time")


def wrapped_ns(stamp_ns: int) -> int:
    """The stamp that ROS can hold instead of this one, for a clock up to the year 2105: the bus knows none beyond."""
    beyond_ns = stamp_ns - (MAX_STAMP_NS + 1)
    return beyond_ns if 0 <= beyond_ns <= MAX_STAMP_NS else stamp_ns


def time(stamp_ns: int) -> Any:
    """A builtin_interfaces/Time of the wrapped stamp."""
    seconds, rest = divmod(wrapped_ns(stamp_ns), NS_PER_S)
    return _classes()[1](sec=seconds, nanosec=rest)


def header(stamp_ns: int, frame: str = "") -> Any:
    """A ROS header with this stamp, wrapped."""
    return _classes()[0](stamp=time(stamp_ns), frame_id=frame)


def stamp_ns(ros_header: Any) -> int:
    """The stamp of a ROS header."""
    return time_ns(ros_header.stamp)


def time_ns(stamp: Any) -> int:
    """Nanoseconds of a builtin_interfaces/Time.

    Raises:
      RefusedValueError: The seconds are negative, or the nanoseconds reach a whole second.
    """
    if stamp.sec < 0 or stamp.nanosec >= NS_PER_S:
        raise RefusedValueError(DecodeRefusal.STAMP_OUT_OF_RANGE)
    return int(stamp.sec * NS_PER_S + stamp.nanosec)
