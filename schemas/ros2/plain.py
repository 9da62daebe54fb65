"""Bytes of a robot's plain ROS 2 topics that are no topics of ours."""

from __future__ import annotations

import struct

from tailor.schemas.ros_time import header
from tailor.schemas.typesystem import ros_class, to_bytes

_HEADER_END = 16  # encapsulation, seconds, nanoseconds, length of the frame's name


def twist_bytes(v: float, omega: float, stamp: tuple[int, str] | None = None) -> bytes:
    """CDR bytes of a velocity.

    Args:
      v: linear.x, m/s.
      omega: angular.z, rad/s.
      stamp: Stamp in nanoseconds and frame, for a geometry_msgs/TwistStamped; None: a geometry_msgs/Twist.
    """
    vector = ros_class("geometry_msgs/msg/Vector3")
    linear, angular = vector(x=v, y=0.0, z=0.0), vector(x=0.0, y=0.0, z=omega)
    twist = ros_class("geometry_msgs/msg/Twist")(linear=linear, angular=angular)
    if stamp is None:
        return to_bytes(twist, "geometry_msgs/msg/Twist")
    kind = ros_class("geometry_msgs/msg/TwistStamped")
    return to_bytes(kind(header=header(*stamp), twist=twist), "geometry_msgs/msg/TwistStamped")


def frame_in(data: bytes) -> str:
    """The frame in the header with which a message begins; empty if the bytes hold none."""
    if len(data) < _HEADER_END:
        return ""
    (length,) = struct.unpack_from("<I" if data[1] else ">I", data, _HEADER_END - 4)
    return data[_HEADER_END : _HEADER_END + max(0, length - 1)].decode(errors="replace")
