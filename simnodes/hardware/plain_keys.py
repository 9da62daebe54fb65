"""Keys and encodings of a robot's own topics under a key profile: the one place that knows them."""

from __future__ import annotations

from tailor.schemas.ros2.graph import Named
from tailor.schemas.typesystem import hash_of
from tailor.simnodes.hardware.plain_settings import RobotBus


def address(bus: RobotBus, topic: str, ros_type: str) -> tuple[str, str]:
    """Key and encoding of a topic.

    Args:
      bus: Profile, and the ROS domain.
      topic: Name in ROS, e.g. "/base/odom".
      ros_type: Its type, e.g. "nav_msgs/msg/Odometry".
    """
    name = topic.strip("/")
    if bus.profile == "rmw_zenoh":
        return Named(name, ros_type, hash_of(ros_type)).key(bus.domain_id), "application/cdr"
    return name, f"application/cdr;{ros_type}"  # as zenoh-bridge-ros2dds routes it
