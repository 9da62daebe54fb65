"""The ROS 2 types behind our messages: names, definition texts, hashes, and the bytes of one value.

The only module that knows rosbags, but for the name of its error in codec.py. Which dataclass becomes which ROS type is
decided here; how its fields are filled is the business of standard.py and own.py.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any, get_args

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tailor.schemas import messages as m

PACKAGE = "tailor_msgs"
STANDARD: dict[type, str] = {
    m.VelocityCommand: "geometry_msgs/msg/TwistStamped",
    m.Odometry: "nav_msgs/msg/Odometry",
    m.PoseEstimate: "geometry_msgs/msg/PoseWithCovarianceStamped",
    m.EStop: "std_msgs/msg/Bool",
    m.Clock: "rosgraph_msgs/msg/Clock",
    m.JointState: "sensor_msgs/msg/JointState",
}
MESSAGES: tuple[type, ...] = get_args(m.Message)
PARTS: tuple[type, ...] = (m.Parameter, m.InstantiatedAction)  # live inside other messages only
MAX_ELEMENTS = 65536  # in one sequence; the longest legal message has fewer


@cache
def typestore() -> Any:
    """rosbags' store of ROS 2 types, with our own registered; made once, takes about 0.1 s."""
    store = get_typestore(Stores.ROS2_JAZZY)
    store.max_sequence_length = MAX_ELEMENTS
    own: dict[str, Any] = {}
    for kind in (*PARTS, *MESSAGES):
        if kind not in STANDARD:
            text = resources.files("tailor.schemas").joinpath("msg", f"{kind.__name__}.msg").read_text(encoding="utf-8")
            own.update(get_types_from_msg(text, ros_type(kind)))
    store.register(own)
    return store


def ros_type(kind: type) -> str:
    """The full ROS name of a message type, e.g. `ros_type(EStop) == "std_msgs/msg/Bool"`."""
    return STANDARD.get(kind, f"{PACKAGE}/msg/{kind.__name__}")


@cache
def type_of(ros_name: str) -> type | None:
    """The message type with this ROS name, None if it is not one of ours."""
    return {ros_type(kind): kind for kind in MESSAGES}.get(ros_name)


@cache
def definition(kind: type) -> str:
    """The `ros2msg` text of a type and of all that it contains, as MCAP's schema wants it."""
    text: str = typestore().generate_msgdef(ros_type(kind), ros_version=2)[0]
    return text


@cache
def type_hash(kind: type) -> str:
    """The type's RIHS01 hash, equal to the one of ROS 2 Iron and later."""
    digest: str = typestore().hash_rihs01(ros_type(kind))
    return digest


def ros_class(name: str) -> Any:
    """The class of rosbags that holds a value of the ROS type `name`."""
    return typestore().types[name]


def to_bytes(value: Any, name: str) -> bytes:
    """A ROS value as little-endian CDR with its 4-byte encapsulation header."""
    return bytes(typestore().serialize_cdr(value, name, little_endian=True))


def from_bytes(data: bytes, name: str) -> tuple[Any, int]:
    """The ROS value in CDR bytes, and how many bytes are left over behind it.

    Real ROS 2 serializers leave padding behind, which `deserialize_cdr` refuses; so the count is handed out.

    Raises:
      ValueError: No CDR header. Other damage raises what codec.DAMAGE lists.
    """
    if len(data) < 4 or data[0] != 0 or data[1] > 1:
        raise ValueError("not a CDR header")
    found = typestore().get_msgdef(name)
    read = found.deserialize_cdr_le if data[1] else found.deserialize_cdr_be
    value, end = read(memoryview(data)[4:], 0, found.cls, typestore())
    return value, len(data) - 4 - end
