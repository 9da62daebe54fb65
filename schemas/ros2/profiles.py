"""Key profiles of the bus: under which keys a session publishes and listens.

`plain` is `<robot>/<topic>`, as behind zenoh-bridge-ros2dds; `rmw_zenoh` are the keys of ROS 2 nodes under rmw_zenoh;
`both` are both at once. A message that is published under both keys is marked under the second, so that sessions which
listen to both take it once. E-stops are published and heard under both keys in every profile.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, get_args

from tailor.schemas.messages import EStop
from tailor.schemas.ros2.graph import Named, parsed_key
from tailor.schemas.topics import TOPICS, Topic
from tailor.schemas.typesystem import ros_type, type_hash

Profile = Literal["plain", "rmw_zenoh", "both"]
PROFILES: tuple[Profile, ...] = get_args(Profile)
MAX_DOMAIN = 232  # of ROS 2
COPY = "application/cdr;copy"  # encoding under the second of two keys
BARE = "application/cdr"  # rmw_zenoh names the type in the key
# Of std_msgs/msg/Bool: an e-stop of the command line does not wait for rosbags to compute it.
ESTOP_HASH = "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"


@dataclass(frozen=True, slots=True)
class KeyProfile:
    """The profile of one session.

    Attributes:
      profile: Which keys.
      domain: ROS_DOMAIN_ID, first part of rmw_zenoh's keys.
    """

    profile: Profile = "plain"
    domain: int = 0

    @property
    def announces(self) -> bool:
        """Whether the session is part of ROS 2's graph."""
        return self.profile != "plain"

    def plain(self, topic: Topic) -> bool:
        """Whether messages of a topic go under its plain key."""
        return self.profile != "rmw_zenoh" or topic.type is EStop

    def ros(self, topic: Topic) -> bool:
        """Whether they go under its key for rmw_zenoh."""
        return self.profile != "plain" or topic.type is EStop

    def heard(self, key: str) -> tuple[str, Topic] | None:
        """Plain key and topic of a received key, if it is the one for rmw_zenoh of a topic that this session hears."""
        known = _in_table(key, self.domain)
        return known if known is not None and self.ros(known[1]) else None


PLAIN = KeyProfile()


def ros_topic(topic: Topic, robot: str) -> Named:
    """A topic of the table as ROS 2 names it; `robot` is "*" for a pattern that matches all robots."""
    return Named(topic.key.format(robot=robot), ros_type(topic.type), _hash(topic.type))


def ros_patterns(topics: Iterable[Topic]) -> list[str]:
    """Patterns of the keys for rmw_zenoh of topics, of all robots in all domains."""
    return sorted({ros_topic(topic, "*").key("*") for topic in topics})


def _hash(kind: type) -> str:
    return ESTOP_HASH if kind is EStop else type_hash(kind)


@lru_cache(maxsize=1024)
def _in_table(key: str, domain: int) -> tuple[str, Topic] | None:
    """Plain key and topic of a key for rmw_zenoh in this domain; None unless it is in the table with type and hash."""
    parsed = parsed_key(key)
    if parsed is None or parsed[0] != domain:
        return None
    topic = topic_at(parsed[1].name)
    if topic is None or ros_topic(topic, parsed[1].name.partition("/")[0]) != parsed[1]:
        return None
    return parsed[1].name, topic


@lru_cache(maxsize=1024)
def topic_at(plain_key: str) -> Topic | None:
    """The topic at a plain key, e.g. that of odometry at "agilo/odom"; None if the table has none."""
    robot = plain_key.partition("/")[0]
    return next((topic for topic in TOPICS.values() if topic.key.format(robot=robot) == plain_key), None)
