"""Encodings of publications: the ROS type of a payload, as `application/cdr;std_msgs/msg/Bool` names it."""

from __future__ import annotations

from tailor.schemas.typesystem import ros_type

_NAMED_CDR = "application/cdr;"


def encoding_of(kind: type) -> str:
    """Encoding of a message type."""
    return encoding_named(ros_type(kind))


def encoding_named(name: str) -> str:
    """Encoding of a ROS type, e.g. "std_msgs/msg/Bool"."""
    return f"{_NAMED_CDR}{name}"


def named_type(encoding: str) -> str:
    """ROS type that an encoding names; empty if it names none."""
    return encoding.removeprefix(_NAMED_CDR) if encoding.startswith(_NAMED_CDR) else ""


def is_of_other_type(encoding: str, expected: str) -> bool:
    """Whether an encoding names another type than the expected encoding; one that names none does not."""
    return encoding.startswith(_NAMED_CDR) and encoding != expected
