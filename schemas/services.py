"""Roles of the processes on a bus, and the table of services: requests with a response, who serves and who may call.

What each role may do derives from this table and that of topics.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

Role = Literal["executive", "driver", "people", "recorder", "observer", "scene", "player"]
ROLES: tuple[Role, ...] = get_args(Role)
MAX_REQUEST_BYTES = 65_536  # of any service
DROP = "(and)"  # a goal without conditions drops the open one


@dataclass(frozen=True, slots=True)
class Service:
    """One row; `pattern` matches the keys of the service for every robot."""

    pattern: str
    server: Role
    callers: tuple[Role, ...] = ("people",)
    ros_name: str = ""  # of the same service for ROS 2 nodes under rmw_zenoh; empty: none


SERVICES: dict[str, Service] = {
    "goal": Service("exec/goal", "executive", ros_name="exec/set_goal"),
    "simulator": Service("*/sim/*", "driver"),  # reset, place, pause, step: simnodes/services.py
    "snapshot": Service("recorder/snapshot", "recorder"),
}
