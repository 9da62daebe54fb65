"""The bytes of the action's messages: requests and responses of its services, its feedback, the states of its goals."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from tailor.schemas.errors import RefusedValueError, Rejected
from tailor.schemas.messages import ExecStatus
from tailor.schemas.ros2.action import ACTION, CANCEL, STATES, achieve_goal
from tailor.schemas.ros2.service import read_request
from tailor.schemas.ros_time import time, time_ns
from tailor.schemas.typesystem import ros_class, to_bytes

ANY_GOAL = bytes(16)  # id in a request to cancel that names no goal


class GoalState(IntEnum):
    """`action_msgs/msg/GoalStatus`."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6


class CancelCode(IntEnum):
    """Return codes of `action_msgs/srv/CancelGoal`."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


@dataclass(frozen=True, slots=True)
class GoalInfo:
    """A goal of the action: its client's id, 16 bytes, and when it was accepted (wall clock)."""

    id: bytes
    stamp_ns: int


@dataclass(frozen=True, slots=True)
class GoalResult:
    """What became of a goal; the fields are those of the action's result."""

    result: str
    reason: str = ""
    detail: str = ""
    duration_s: float = 0.0


def prime() -> None:
    """Use every message once, before the first tick: the first use compiles them."""
    achieve_goal()
    header, info = b"\0\1\0\0", GoalInfo(ANY_GOAL, 0)
    sent_goal(header + ANY_GOAL + b"\1\0\0\0\0")  # the length of an empty text, and its end
    goals_to_cancel(header + ANY_GOAL + bytes(8))
    requested_result(header + ANY_GOAL)
    sent_response(True, 0)
    cancel_response(CancelCode.NONE, [info])
    result_response(GoalState.UNKNOWN, GoalResult(""))
    states_message([(info, GoalState.UNKNOWN)])
    feedback_message(ANY_GOAL, ExecStatus(0, 0, "", "", "", "", "", "", 0, 0.0, 0.0))


def sent_goal(data: bytes) -> tuple[bytes, str] | Rejected:
    """Id and goal of a request to pursue one."""
    ros = read_request(data, f"{ACTION}_SendGoal_Request")
    return ros if isinstance(ros, Rejected) else (_id(ros.goal_id), str(ros.goal.goal))


def sent_response(accepted: bool, stamp_ns: int) -> bytes:
    """Response to it."""
    name = f"{ACTION}_SendGoal_Response"
    return to_bytes(ros_class(name)(accepted, time(stamp_ns)), name)


def goals_to_cancel(data: bytes) -> GoalInfo | Rejected:
    """What a request to cancel names: one goal, those until a time, or all; see `action_msgs/srv/CancelGoal`."""
    ros = read_request(data, f"{CANCEL}_Request")
    if isinstance(ros, Rejected):
        return ros
    try:
        return GoalInfo(_id(ros.goal_info.goal_id), time_ns(ros.goal_info.stamp))
    except RefusedValueError as error:
        return Rejected(str(error))


def cancel_response(code: CancelCode, goals: Iterable[GoalInfo]) -> bytes:
    """Response to it, with the goals that are being cancelled."""
    return to_bytes(ros_class(f"{CANCEL}_Response")(code.value, [_info(goal) for goal in goals]), f"{CANCEL}_Response")


def requested_result(data: bytes) -> bytes | Rejected:
    """Id of the goal whose result is requested."""
    ros = read_request(data, f"{ACTION}_GetResult_Request")
    return ros if isinstance(ros, Rejected) else _id(ros.goal_id)


def result_response(state: GoalState, result: GoalResult) -> bytes:
    """Response to it."""
    name = f"{ACTION}_GetResult_Response"
    ros = ros_class(f"{ACTION}_Result")(result.result, result.reason, result.detail, result.duration_s)
    return to_bytes(ros_class(name)(state.value, ros), name)


def feedback_message(goal: bytes, status: ExecStatus) -> bytes:
    """Feedback to the client of a goal, from the status of a tick."""
    ros = ros_class(f"{ACTION}_Feedback")(
        status.mode,
        status.reason,
        status.action,
        status.action_index,
        status.action_elapsed_s,
        status.action_predicted_s,
    )
    name = f"{ACTION}_FeedbackMessage"
    return to_bytes(ros_class(name)(_uuid(goal), ros), name)


def states_message(goals: Iterable[tuple[GoalInfo, GoalState]]) -> bytes:
    """The states of all known goals."""
    state = ros_class("action_msgs/msg/GoalStatus")
    return to_bytes(ros_class(STATES)([state(_info(goal), value.value) for goal, value in goals]), STATES)


def _info(goal: GoalInfo) -> Any:
    return ros_class("action_msgs/msg/GoalInfo")(_uuid(goal.id), time(goal.stamp_ns))


def _uuid(goal: bytes) -> Any:
    import numpy as np  # of no use to a command that only waits for a goal

    return ros_class("unique_identifier_msgs/msg/UUID")(np.frombuffer(goal, dtype=np.uint8))


def _id(uuid: Any) -> bytes:
    return bytes(uuid.uuid)
