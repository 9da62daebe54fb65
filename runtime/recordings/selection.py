"""Which messages to record, replay or keep: by topic name, key pattern or type."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from tailor.schemas.errors import UsageError
from tailor.schemas.topics import TOPICS


@dataclass(frozen=True, slots=True)
class Selection:
    """A message is wanted if a pattern of `include` matches (none: all) and none of `exclude` does."""

    include: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()

    def allows(self, key: str, ros_name: str = "") -> bool:
        """Whether nothing of `exclude` matches."""
        return not any(_matches(pattern, key, ros_name) for pattern in self.exclude)

    def wants(self, key: str, ros_name: str = "") -> bool:
        """Whether a message of this key and ROS type is wanted."""
        if not self.allows(key, ros_name):
            return False
        return not self.include or any(_matches(pattern, key, ros_name) for pattern in self.include)


def selection(include: Sequence[str], exclude: Sequence[str]) -> Selection:
    """A selection from what people write: `odom`, `agilo/*`, `exec/**`, `nav_msgs/msg/Odometry`; commas separate.

    Raises:
      UsageError: A word that is neither a topic's name nor a pattern nor a type.
    """
    parts = [tuple(word for text in texts for word in text.split(",") if word) for texts in (include, exclude)]
    for word in (*parts[0], *parts[1]):
        if word not in TOPICS and "/" not in word and "*" not in word:
            known = ", ".join(TOPICS)
            raise UsageError(f"topic {word!r}: expected a name ({known}), a key pattern like agilo/* or a type")
    unrecorded = () if parts[0] else tuple(name for name, topic in TOPICS.items() if not topic.recorded)
    return Selection(parts[0], parts[1] + unrecorded)


def _matches(pattern: str, key: str, ros_name: str) -> bool:
    if pattern in TOPICS:
        return fnmatchcase(key, TOPICS[pattern].key.format(robot="*"))
    return fnmatchcase(key, pattern.replace("**", "*")) or (ros_name != "" and pattern == ros_name)
