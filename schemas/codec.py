"""Bytes of the bus <-> typed values. Reading is total: a message or a Rejected, never an exception.

Payloads are ROS 2 CDR. Writing does not judge; reading refuses what is too long, damaged, or no number to reckon with.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any

from rosbags.serde import SerdeError

from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.schemas.own import converters, example
from tailor.schemas.ros_time import Refusal
from tailor.schemas.standard import CONVERTERS
from tailor.schemas.topics import TOPICS, Topic
from tailor.schemas.typesystem import MESSAGES, from_bytes, ros_type, to_bytes

TRAILING_BYTES = 7  # padding that real ROS 2 serializers leave behind a message
DAMAGE = (SerdeError, struct.error, ValueError, IndexError, OverflowError)  # what rosbags raises on bad bytes
_LIMITS = {kind: max((t.max_bytes for t in TOPICS.values() if t.type is kind), default=4096) for kind in MESSAGES}


@cache
def _codec(kind: type) -> tuple[Any, Any, str]:
    write, read = CONVERTERS[kind] if kind in CONVERTERS else converters(kind)
    return write, read, ros_type(kind)


def encode(message: Message) -> bytes:
    """The message as CDR.

    Raises:
      struct.error: A stamp or an integer does not fit its ROS type; that is our own mistake.
    """
    kind: Any = type(message)
    write, _, name = _codec(kind)
    return to_bytes(write(message), name)


def decode(what: Topic | type[Message], data: bytes) -> Message | Rejected:
    """The message in CDR bytes that came over a topic (or of a type), or why it is refused.

    The number of different reasons is small, so that they can be counted: "too long", "malformed", "trailing bytes",
    "not finite", "number too large", "negative variance", "stamp out of range", "orientation is not a unit quaternion",
    "a joint lacks a value".
    """
    kind: type = what.type if isinstance(what, Topic) else what
    limit = what.max_bytes if isinstance(what, Topic) else _LIMITS[what]
    if len(data) > limit:
        return Rejected("too long")
    _, read, name = _codec(kind)
    try:
        value, left = from_bytes(data, name)
        if not 0 <= left <= TRAILING_BYTES:
            return Rejected("trailing bytes")
        message: Message = read(value)
    except Refusal as refusal:
        return Rejected(str(refusal))
    except DAMAGE:
        return Rejected("malformed")
    return message


def prime() -> None:
    """Use every codec once before the first tick: the first use of a type compiles it, which takes up to 0.3 s."""
    for kind in MESSAGES:
        decode(kind, encode(example(kind)))
