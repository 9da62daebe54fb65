"""Stamps: nanoseconds of one integer on our side, `std_msgs/Header` on ROS's.

Every stamped message carries a whole header, because viewers plot over `header.stamp` and know frames by it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from schemas.typesystem import ros_class

NS_PER_S = 1_000_000_000
MAX_STAMP_NS = 2**31 * NS_PER_S - 1  # builtin_interfaces/Time holds int32 seconds


class Refusal(ValueError):
    """A value inside a message that must not come in; its text is the reason that gets counted."""


@cache
def _classes() -> tuple[Any, Any]:
    return ros_class("std_msgs/msg/Header"), ros_class("builtin_interfaces/msg/Time")


def header(stamp_ns: int, frame: str = "") -> Any:
    """A ROS header with this stamp, 0 <= stamp_ns <= MAX_STAMP_NS."""
    header_class, time_class = _classes()
    seconds, rest = divmod(stamp_ns, NS_PER_S)
    return header_class(stamp=time_class(sec=seconds, nanosec=rest), frame_id=frame)


def stamp_ns(ros_header: Any) -> int:
    """The stamp of a ROS header; negative seconds or more than a second of nanoseconds are refused."""
    stamp = ros_header.stamp
    if stamp.sec < 0 or stamp.nanosec >= NS_PER_S:
        raise Refusal("stamp out of range")
    return int(stamp.sec * NS_PER_S + stamp.nanosec)
