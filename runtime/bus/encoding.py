"""Encodings of publications: the ROS type of a payload, as `application/cdr;std_msgs/msg/Bool` names it."""

from __future__ import annotations

from tailor.schemas.typesystem import ros_type

NAMED_CDR = "application/cdr;"


def encoding_of(kind: type) -> str:
    """Encoding of a message type."""
    return f"{NAMED_CDR}{ros_type(kind)}"


def named_type(encoding: str) -> str:
    """ROS type that an encoding names; empty if it names none."""
    return encoding.removeprefix(NAMED_CDR) if encoding.startswith(NAMED_CDR) else ""


def is_of_other_type(encoding: str, expected: str) -> bool:
    """Whether an encoding names another type than the expected encoding; one that names none does not."""
    return encoding.startswith(NAMED_CDR) and encoding != expected
