"""Converts messages to bytes and back. Decoding is total: it returns a message or a Rejected and never raises.

Payloads are ROS 2 CDR. Encoding checks nothing; decoding refuses bytes that are too long or damaged, and bad numbers.
The first use loads rosbags and NumPy: 0.2 s that an e-stop of the command line does not wait for.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any

from tailor.schemas.bad_field import not_finite_field
from tailor.schemas.errors import DecodeRefusal, RefusedValueError, Rejected
from tailor.schemas.messages import Message
from tailor.schemas.topics import TOPICS, Topic
from tailor.schemas.typesystem import from_bytes, message_types, ros_type, to_bytes

MAX_TRAILING_BYTES = 7  # padding that real ROS 2 serializers append


@cache
def _codec(kind: type) -> tuple[Any, Any, str]:
    from tailor.schemas import scene_markers, standard
    from tailor.schemas.own import converters

    known = standard.CONVERTERS | scene_markers.CONVERTERS
    write, read = known[kind] if kind in known else converters(kind)
    return write, read, ros_type(kind)


@cache
def _limit(kind: type) -> int:
    return max((topic.max_bytes for topic in TOPICS.values() if topic.type is kind), default=4096)


@cache
def damage() -> tuple[type[Exception], ...]:
    """Errors of rosbags on bad bytes; for an `except`."""
    from rosbags.serde import SerdeError

    return (SerdeError, struct.error, ValueError, IndexError, OverflowError)


def encode(message: Message) -> bytes:
    """The CDR bytes of a message.

    Raises:
      struct.error: A stamp or an integer does not fit its ROS type; a mistake of the caller.
    """
    kind: Any = type(message)
    write, _, name = _codec(kind)
    return to_bytes(write(message), name)


def decode(what: Topic | type[Message], data: bytes) -> Message | Rejected:
    """Decode a received message.

    Args:
      what: The topic it came over, or its type.
      data: CDR bytes with their encapsulation header.

    Returns:
      The message, or a Rejected whose reason is a value of DecodeRefusal.
    """
    kind: type = what.type if isinstance(what, Topic) else what
    limit = what.max_bytes if isinstance(what, Topic) else _limit(kind)
    if len(data) > limit:
        return Rejected(DecodeRefusal.TOO_LONG.value)
    _, read, name = _codec(kind)
    value: Any = None
    try:
        value, left = from_bytes(data, name)
        if not 0 <= left <= MAX_TRAILING_BYTES:
            return Rejected(DecodeRefusal.TRAILING_BYTES.value)
        message: Message = read(value)
    except RefusedValueError as error:
        return Rejected(error.reason.value, _where(error.reason, value))
    except damage():
        return Rejected(DecodeRefusal.MALFORMED.value)
    return message


def _where(reason: DecodeRefusal, value: Any) -> str:
    return not_finite_field(value) if reason is DecodeRefusal.NOT_FINITE else ""


def prime() -> None:
    """Use every codec once, before the first tick: the first use of a type compiles it and takes up to 0.3 s."""
    from tailor.schemas.own import example

    damage()
    for kind in message_types():
        decode(kind, encode(example(kind)))
