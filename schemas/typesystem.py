"""The ROS 2 types of our messages: names, definition texts, hashes, and the bytes of one value.

Only this module and ros_types/ use rosbags, except for its error type in codec.py; they load it when it is
first needed. standard.py and own.py convert the fields.
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

from tailor.schemas.messages import Message
from tailor.schemas.packages.msg_definitions import declarations, with_parts
from tailor.schemas.packages.ros_names import PACKAGE, ros_type
from tailor.schemas.topics import TOPICS

__all__ = [
    "add_message",
    "add_service",
    "definition",
    "from_bytes",
    "hash_of",
    "hash_of_definition",
    "message_types",
    "own_types",
    "ros_class",
    "ros_type",
    "to_bytes",
    "type_hash",
    "type_of",
    "typestore",
]
MAX_DEFINITION_CHARS = 30_000  # ten times MarkerArray's with its comments; the parser takes 0.3 s for as many line ends
MAX_ELEMENTS = 65536  # in one sequence; the longest legal message has fewer


@cache
def message_types() -> tuple[type[Message], ...]:
    """Types of all topics, each once."""
    return tuple(dict.fromkeys(topic.type for topic in TOPICS.values()))


@cache
def own_types() -> tuple[type, ...]:
    """Types that ROS 2 does not define, with the types nested in them, parts before wholes."""
    return with_parts(kind for kind in message_types() if not kind.ROS_TYPE)


@cache
def typestore() -> Any:
    """rosbags' store of ROS 2 types with our own registered; made once, takes about 0.1 s.

    Raises:
      TypesysError: A package defines a type of ROS 2 otherwise.
    """
    from tailor.schemas.ros_types.cdr_store import CdrStore
    from tailor.schemas.ros_types.common_interfaces import COMMON
    from tailor.schemas.ros_types.plain_definitions import read_definition

    own = {ros_type(kind): "\n".join(declarations(kind).values()) for kind in own_types()}
    ours = {name: text for name, text in own.items() if name.startswith(f"{PACKAGE}/")}
    store = CdrStore({name: read_definition(text) for name, text in (COMMON | ours).items()}, MAX_ELEMENTS)
    if others := {name: read_definition(own[name]) for name in own.keys() - ours.keys()}:
        store.require(others)  # a package may have named a type as ROS 2 does
        store.register(others)
    return store


@cache
def _types_by_name() -> dict[str, type[Message]]:
    return {ros_type(kind): kind for kind in message_types()}


def type_of(ros_name: str) -> type[Message] | None:
    """The message type with this ROS name; None if no topic carries it. Not cached by name: strangers choose names."""
    return _types_by_name().get(ros_name)


@cache
def definition(kind: type) -> str:
    """The `ros2msg` text of a type and of all types nested in it, as an MCAP schema requires it."""
    text: str = typestore().generate_msgdef(ros_type(kind), ros_version=2)[0]
    return text


@cache
def type_hash(kind: type) -> str:
    """The type's RIHS01 hash (REP-2016), equal to that of ROS 2 Iron and later."""
    return hash_of(ros_type(kind))


@cache
def hash_of(name: str) -> str:
    """The RIHS01 hash of a ROS type of ours or of ROS 2's common interfaces, by its name.

    Raises:
      KeyError: The type is unknown.
    """
    digest: str = typestore().hash_rihs01(name)
    return digest


@lru_cache(maxsize=256)  # a file has as many channels of a type as senders
def hash_of_definition(name: str, text: str) -> str:
    """The RIHS01 hash of a type by its `ros2msg` text, wherever that is from; empty if it is none that can be read.

    Constants, comments, the order of nested types and the way in which their names are written do not count.
    """
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    if len(text) > MAX_DEFINITION_CHARS:
        return ""
    try:
        store = get_typestore(Stores.EMPTY)
        store.register(get_types_from_msg(text, name))
        digest: str = store.hash_rihs01(name)
    except Exception:
        return ""
    return digest


def add_message(name: str, text: str) -> None:
    """Register a message that no topic of the table carries, by its ROS name and its ROS 2 definition."""
    from rosbags.typesys import get_types_from_msg

    typestore().register(get_types_from_msg(text, name))


def add_service(name: str, request: str, response: str) -> None:
    """Register a service, so that `hash_of(name)` and the bytes of `NAME_Request` and `NAME_Response` are known.

    Args:
      name: ROS name of the service, e.g. "std_srvs/srv/SetBool".
      request: ROS 2 definition of the request, the part of the .srv file above the dashes.
      response: The part below them.
    """
    from rosbags.interfaces import Nodetype
    from rosbags.typesys import get_types_from_msg

    def one(part: str) -> Any:
        return Nodetype.NAME, part

    def at_most_one(part: str) -> Any:
        return Nodetype.SEQUENCE, (one(part), 1)

    info, request_name, response_name = "service_msgs/msg/ServiceEventInfo", f"{name}_Request", f"{name}_Response"
    texts = {request_name: request, response_name: response}
    parts = {part: get_types_from_msg(text, part) for part, text in texts.items()}
    types: dict[str, Any] = {part: next(iter(read.values())) for part, read in parts.items()}
    event = [("info", one(info)), ("request", at_most_one(request_name)), ("response", at_most_one(response_name))]
    types[f"{name}_Event"] = ([], event)
    messages = [
        ("request_message", request_name),
        ("response_message", response_name),
        ("event_message", f"{name}_Event"),
    ]
    types[name] = ([], [(field, one(part)) for field, part in messages])  # so do ROS 2's type descriptions
    typestore().register(types)


def ros_class(name: str) -> Any:
    """The rosbags class for values of the ROS type `name`."""
    return typestore().types[name]


def to_bytes(value: Any, name: str) -> bytes:
    """A ROS value as little-endian CDR with its 4-byte encapsulation header."""
    return bytes(typestore().serialize_cdr(value, name, little_endian=True))


def from_bytes(data: bytes, name: str) -> tuple[Any, int]:
    """The ROS value in CDR bytes, and the number of bytes left over behind it.

    `deserialize_cdr` refuses the padding that real ROS 2 serializers append; so the caller judges the rest.

    Raises:
      ValueError: No CDR header. Other damage raises one of codec's damages.
    """
    if len(data) < 4 or data[0] != 0 or data[1] > 1:
        raise ValueError("not a CDR header")
    message_definition = typestore().get_msgdef(name)
    read = message_definition.deserialize_cdr_le if data[1] else message_definition.deserialize_cdr_be
    value, end = read(memoryview(data)[4:], 0, message_definition.cls, typestore())
    return value, len(data) - 4 - end
