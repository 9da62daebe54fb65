"""Names of message types in ROS 2."""

from __future__ import annotations

PACKAGE = "tailor_msgs"


def ros_type(kind: type) -> str:
    """Full ROS name of a message type, e.g. `ros_type(EStop) == "std_msgs/msg/Bool"`."""
    return getattr(kind, "ROS_TYPE", "") or f"{getattr(kind, 'ROS_PACKAGE', PACKAGE)}/msg/{kind.__name__}"
