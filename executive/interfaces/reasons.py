"""Reasons of the executive as data: why it holds, is disarmed, faults, fails a task, ends an action, refuses a goal.

`REASONS` is the one table; docs/reasons.md lists it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from tailor.schemas.reason_text import reason_text


class Reason(StrEnum):
    """Reason in a message of the executive; the free text beside it is its detail."""

    DRIVER_SILENT = "driver silent"
    DRIVER_NOT_ARMED = "driver not armed"
    DRIVER_OBEYS_ANOTHER = "driver obeys another"
    CLOCK_BACKWARD = "clock backward"
    INPUT_STALE = "input stale"
    INPUT_SLOW = "input slow"
    BELIEF_NOT_READY = "belief not ready"
    ROUND_TRIP = "round trip"
    OVERRUNS = "overruns"
    REPEATED_FAILURE = "repeated failure"
    CONTROLLER_FAILED = "controller failed"
    COMMAND_INVALID = "command invalid"
    ACTION_TIMEOUT = "action timeout"
    ROBOT_CARRIED = "robot carried"
    EFFECTS_HOLD = "effects hold"
    SUPERSEDED = "superseded"
    COURSE_AT_RISK = "course at risk"
    SUPPORT_LOST = "support lost"
    DISARMED = "disarmed"
    NEW_GOAL = "new goal"
    CANCELLED = "cancelled"
    SHUTDOWN = "shutdown"
    PLANNER_FAILED = "planner failed"
    PLAN_UNREADABLE = "plan unreadable"
    PLAN_UNSOUND = "plan unsound"
    UNSOLVABLE = "unsolvable"
    SEARCH_LIMIT = "search limit"
    PDDL_UNSUPPORTED = "pddl unsupported"
    NOT_INSTANTIABLE = "not instantiable"
    NO_SUBGOAL = "no subgoal"
    NO_VALID_CHOICE = "no valid choice"
    GOAL_TOO_LONG = "goal too long"
    GOAL_INVALID = "goal invalid"


class Row(NamedTuple):
    """What a reason is the reason of, its meaning, and the content of its detail."""

    effect: str
    meaning: str
    detail: str


DISARMED, HOLDING, FAULT = "mode DISARMED", "mode HOLDING", "mode FAULT"
ACTION, PLAN, TASK, GOAL = "action ended", "plan refused", "task failed", "goal refused"

REASONS: dict[Reason, Row] = {
    Reason.DRIVER_SILENT: Row(DISARMED, "no fresh state of the driver", "robot"),
    Reason.DRIVER_NOT_ARMED: Row(DISARMED, "the driver is not armed", "mode and reason of the driver"),
    Reason.DRIVER_OBEYS_ANOTHER: Row(DISARMED, "the driver obeys another executive", "sender id, first 8 digits"),
    Reason.CLOCK_BACKWARD: Row(HOLDING, "the time of this tick lies before the last one", ""),
    Reason.INPUT_STALE: Row(
        HOLDING, "a required sensor is stale or has never been received", "topics; what is wrong with their messages"
    ),
    Reason.INPUT_SLOW: Row(HOLDING, "a required sensor is below 60 % of its rate: no action starts", "topics, rates"),
    Reason.BELIEF_NOT_READY: Row(HOLDING, "the belief does not yet suffice to act", ""),
    Reason.ROUND_TRIP: Row(HOLDING, "command and driver state take too long, there and back", "age of the echo, limit"),
    Reason.OVERRUNS: Row(HOLDING, "too many ticks of the last second lost whole periods", "number of overruns"),
    Reason.REPEATED_FAILURE: Row(
        FAULT, "an action fails again and again, or is done again and again without effect", "action and cause"
    ),
    Reason.CONTROLLER_FAILED: Row(ACTION, "failed: the controller has given up", "text of the controller"),
    Reason.COMMAND_INVALID: Row(ACTION, "failed: the command is not finite or has the wrong length", "the value"),
    Reason.ACTION_TIMEOUT: Row(ACTION, "failed: the action exceeded its time limit", "the limit"),
    Reason.ROBOT_CARRIED: Row(
        ACTION,
        "failed: poses are elsewhere than odometry leads: the robot was moved by others, or its wheels slip at an "
        "obstacle; it decides anew",
        "",
    ),
    Reason.EFFECTS_HOLD: Row(ACTION, "done: its effects held before its controller ended", ""),
    Reason.SUPERSEDED: Row(ACTION, "aborted: a new decision begins with another action", ""),
    Reason.COURSE_AT_RISK: Row(
        ACTION, "aborted: failure became likely beside objects, or too fast for a new way; decides anew at rest", ""
    ),
    Reason.SUPPORT_LOST: Row(
        ACTION, "aborted: the plan needs what no longer holds; another plan, on the way or at rest", "the literal"
    ),
    Reason.DISARMED: Row(ACTION, "aborted: the driver no longer obeys; it decides anew", "cause of mode DISARMED"),
    Reason.NEW_GOAL: Row(ACTION, "aborted: another goal was set", ""),
    Reason.CANCELLED: Row(ACTION, "aborted: the goal was dropped", ""),
    Reason.SHUTDOWN: Row(ACTION, "aborted: the executive comes to rest and ends", ""),
    Reason.PLANNER_FAILED: Row(PLAN, "the external planner failed; the search takes over", "outcome, its text"),
    Reason.PLAN_UNREADABLE: Row(PLAN, "the external planner's output is no plan; the search takes over", "first error"),
    Reason.PLAN_UNSOUND: Row(PLAN, "the plan does not reach the goal; the search takes over", "first fault"),
    Reason.UNSOLVABLE: Row(
        TASK, "the search has proven that there is no plan", "text of the search; the abstract state, as believed"
    ),
    Reason.SEARCH_LIMIT: Row(TASK, "the search reached a limit without a plan", "the limit"),
    Reason.PDDL_UNSUPPORTED: Row(TASK, "the search does not support the problem", "the construct"),
    Reason.NOT_INSTANTIABLE: Row(
        TASK, "the predicates over a label exclude each other, in all plans tried", "step and label"
    ),
    Reason.NO_SUBGOAL: Row(TASK, "no asserted subgoal makes the plan likely to succeed", "action"),
    Reason.NO_VALID_CHOICE: Row(TASK, "every choice of the free parameters is predicted to fail", ""),
    Reason.GOAL_TOO_LONG: Row(GOAL, "the goal's text does not fit into a status", "its length and the maximum"),
    Reason.GOAL_INVALID: Row(GOAL, "the goal is no PDDL goal of the scenario's problem", "position and error"),
}


class Result(StrEnum):
    """Result of a task; OPEN until it is achieved, has failed, or its goal was dropped."""

    OPEN = ""
    ACHIEVED = "achieved"
    FAILED = "failed"
    CANCELLED = "cancelled"


MAX_DETAIL_BYTES = 2000  # in a message: a status has two details, and may have a goal of 8000 bytes beside them


@dataclass(frozen=True, slots=True)
class Cause:
    """A reason with its detail; as text "reason: detail"."""

    reason: Reason
    detail: str = ""

    def __str__(self) -> str:
        """The reason, and the detail if there is one."""
        return reason_text(self.reason, self.detail)

    @property
    def bus_detail(self) -> str:
        """The detail as messages carry it: text on the bus, short enough for every topic; packages write some."""
        return self.detail.encode(errors="backslashreplace")[:MAX_DETAIL_BYTES].decode(errors="ignore")
