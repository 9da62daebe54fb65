"""Selection of messages to record, replay or copy: by topic name, key pattern or type."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.action import NAME
from tailor.schemas.topics import TOPICS

ACTION = f"*/{NAME}/_action/**"  # what its clients hear; `exec/status` has more of it


@dataclass(frozen=True, slots=True)
class Selection:
    """Selects a message if a pattern of `include` matches (empty: all) and none of `exclude` does."""

    include: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()

    def allows(self, key: str, ros_name: str = "") -> bool:
        """Whether no pattern of `exclude` matches."""
        return not any(_matches(pattern, key, ros_name) for pattern in self.exclude)

    def wants(self, key: str, ros_name: str = "") -> bool:
        """Whether a message of this key and ROS type is selected."""
        if not self.allows(key, ros_name):
            return False
        return not self.include or any(_matches(pattern, key, ros_name) for pattern in self.include)


def selection(include: Sequence[str], exclude: Sequence[str], everything: bool = False) -> Selection:
    """Parse a selection: words such as `odom`, `agilo/*`, `exec/**`, `nav_msgs/msg/Odometry`, separated by commas.

    Args:
      include: Texts with words; none: all.
      exclude: Likewise, what is left out.
      everything: Whether "all" includes what is recorded, or replayed, on request alone, such as a clock.

    Raises:
      UsageError: A word is neither a topic name nor a pattern nor a type, or `include` has texts without a word.
    """
    parts = [tuple(word for text in texts for word in text.split(",") if word) for texts in (include, exclude)]
    if include and not parts[0]:
        raise UsageError(f"topics {','.join(include)!r}: expected at least one, e.g. odom")
    for word in (*parts[0], *parts[1]):
        if word not in TOPICS and "/" not in word and "*" not in word:
            names = ", ".join(TOPICS)
            raise UsageError(f"topic {word!r}: expected a name ({names}), a key pattern like agilo/* or a type")
    unrecorded = (
        () if parts[0] or everything else (*(name for name, topic in TOPICS.items() if not topic.recorded), ACTION)
    )
    return Selection(parts[0], parts[1] + unrecorded)


def _matches(pattern: str, key: str, ros_name: str) -> bool:
    if pattern in TOPICS:
        return fnmatchcase(key, TOPICS[pattern].key.format(robot="*"))
    return fnmatchcase(key, pattern.replace("**", "*")) or (ros_name != "" and pattern == ros_name)
