"""Reads any publication on the bus: the topic and robot of its key, and its message; or why it is none of ours."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.runtime.bus.attachment import Origin, unpack
from tailor.runtime.bus.encoding import encoding_of, is_of_other_type
from tailor.runtime.bus.inbox import Raw
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.schemas.topics import TOPICS, Topic

_ROBOT = "{robot}/"
_FIXED = {topic.key: name for name, topic in TOPICS.items() if not topic.key.startswith(_ROBOT)}
_OF_ROBOTS = sorted(
    ((topic.key.removeprefix("{robot}"), name) for name, topic in TOPICS.items() if name not in _FIXED.values()),
    key=lambda row: -len(row[0]),  # `/sim/joints` before a shorter ending
)
MAX_KEY = 200  # characters; longer ones are foreign


@dataclass(frozen=True, slots=True)
class Received:
    """A message with its topic, robot and origin."""

    name: str  # of the topic
    robot: str  # empty for topics without one
    message: Message
    origin: Origin


def topic_of(key: str) -> tuple[str, str] | None:
    """Name of the topic and robot of a key, e.g. ("odom", "agilo") of agilo/odom; None for a foreign key."""
    if key in _FIXED:
        return _FIXED[key], ""
    if len(key) > MAX_KEY or "*" in key:
        return None
    for ending, name in _OF_ROBOTS:
        if key.endswith(ending) and len(key) > len(ending):
            return name, key.removesuffix(ending)
    return None


def topic_by_ending(key: str) -> Topic | None:
    """Topic of a key, whatever the name of its robot: that of odometry at hall/agilo/odom; None for a foreign key."""
    match = topic_of(key)
    return None if match is None else TOPICS[match[0]]


def read(raw: Raw) -> Received | Rejected | None:
    """The message of a publication; Rejected for a damaged one under a key of ours, None for a foreign key."""
    match = topic_of(raw.key)
    if match is None:
        return None
    topic = TOPICS[match[0]]
    if not raw.is_put:
        return Rejected("not a put")
    if is_of_other_type(raw.encoding, encoding_of(topic.type)):
        return Rejected("other type")
    origin = unpack(raw.attachment)
    if isinstance(origin, Rejected):
        return origin
    message = decode(topic, raw.payload)
    return message if isinstance(message, Rejected) else Received(*match, message, origin)
