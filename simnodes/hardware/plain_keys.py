"""Keys and encodings of a robot's own topics under a key profile: the one place that knows them."""

from __future__ import annotations

from tailor.runtime.bus.encoding import encoding_named
from tailor.schemas.ros2.graph import Named
from tailor.schemas.ros2.profiles import BARE
from tailor.schemas.typesystem import hash_of
from tailor.simnodes.hardware.plain_settings import RobotBus


def named(topic: str, ros_type: str) -> Named:
    """A topic as ROS 2 names it.

    Args:
      topic: Name in ROS, e.g. "/base/odom".
      ros_type: Its type, e.g. "nav_msgs/msg/Odometry".
    """
    return Named(topic.strip("/"), ros_type, hash_of(ros_type))


def address(bus: RobotBus, topic: Named) -> tuple[str, str]:
    """Key and encoding of a topic under the profile and in the ROS domain of the robot's bus."""
    if bus.profile == "rmw_zenoh":
        return topic.key(bus.domain_id), BARE
    return topic.name, encoding_named(topic.type)  # as zenoh-bridge-ros2dds routes it
