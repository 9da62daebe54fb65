"""The ROS 2 service that sets a goal, `tailor_msgs/srv/SetGoal`: its definition, and the bytes of both its messages."""

from __future__ import annotations

from functools import cache
from typing import Any

from tailor.schemas.codec import MAX_TRAILING_BYTES, damage
from tailor.schemas.errors import DecodeRefusal, Rejected
from tailor.schemas.packages.ros_names import PACKAGE
from tailor.schemas.ros2.graph import Named
from tailor.schemas.services import MAX_REQUEST_BYTES, SERVICES
from tailor.schemas.typesystem import add_service, from_bytes, hash_of, ros_class, to_bytes

SET_GOAL = f"{PACKAGE}/srv/SetGoal"
REQUEST = "string goal  # in PDDL, e.g. (and (final pos3) (atball pos3)); empty: the goal of the scenario"
RESPONSE = "bool accepted\nstring message  # the cause, if it was refused"


def text() -> str:
    """Content of the `.srv` file."""
    return f"# Sets the goal of the running executive.\n{REQUEST}\n---\n{RESPONSE}\n"


def set_goal() -> Named:
    """The service as ROS 2 names it."""
    return Named(SERVICES["goal"].ros_name, SET_GOAL, set_goal_hash())


def prime() -> None:
    """Use both messages once, before the first tick: the first use compiles them."""
    goal_of(request(""))
    result_of(response(True, ""))


@cache
def set_goal_hash() -> str:
    """RIHS01 hash of the service; the key of rmw_zenoh contains it."""
    add_service(SET_GOAL, REQUEST, RESPONSE)
    return hash_of(SET_GOAL)


def request(goal: str) -> bytes:
    """CDR bytes of a request."""
    set_goal_hash()
    return to_bytes(ros_class(f"{SET_GOAL}_Request")(goal), f"{SET_GOAL}_Request")


def response(accepted: bool, message: str) -> bytes:
    """CDR bytes of a response."""
    set_goal_hash()
    return to_bytes(ros_class(f"{SET_GOAL}_Response")(accepted, message), f"{SET_GOAL}_Response")


def goal_of(data: bytes) -> str | Rejected:
    """The goal in a request's CDR bytes."""
    ros = _read(data, "Request")
    return ros if isinstance(ros, Rejected) else str(ros.goal)


def result_of(data: bytes) -> tuple[bool, str] | Rejected:
    """(accepted, message) in a response's CDR bytes."""
    ros = _read(data, "Response")
    return ros if isinstance(ros, Rejected) else (bool(ros.accepted), str(ros.message))


def read_request(data: bytes, name: str) -> Any:
    """The ROS value in CDR bytes of a request, or of a response, of the type `name`; Rejected if they hold none."""
    if len(data) > MAX_REQUEST_BYTES:
        return Rejected(DecodeRefusal.TOO_LONG.value)
    try:
        value, left = from_bytes(data, name)
    except damage():
        return Rejected(DecodeRefusal.MALFORMED.value)
    return value if 0 <= left <= MAX_TRAILING_BYTES else Rejected(DecodeRefusal.TRAILING_BYTES.value)


def _read(data: bytes, part: str) -> Any:
    set_goal_hash()
    return read_request(data, f"{SET_GOAL}_{part}")
