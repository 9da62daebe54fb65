"""State of the executive after each tick, and the outcomes of its actions."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class ExecStatus(Message):
    """The executive's state at the end of a tick."""

    stamp_ns: int
    tick: int
    mode: str  # DISARMED READY EXECUTING HOLDING FAULT
    reason: str  # of the mode, see docs/reasons.md
    scenario: str
    goal: str
    result: str  # "", "achieved", "failed", "cancelled"
    action: str  # e.g. "goToPose", empty between actions
    action_index: int
    action_elapsed_s: float
    action_predicted_s: float
    belief: tuple[float, ...] = ()  # in the order of the domain's belief_names
    sender: str = ""  # this executive's sender id, 32 hex digits
    detail: str = ""  # of the reason
    result_reason: str = ""  # of a failed task
    result_detail: str = ""


@dataclass(frozen=True, slots=True)
class ActionFinished(Message):
    """Outcome of an action, with its actual and its predicted duration."""

    stamp_ns: int
    tick: int
    action: str
    action_index: int
    outcome: str  # "done", "failed", "aborted"
    reason: str  # empty if the controller ended it with "done"
    predicted_s: float
    actual_s: float  # without the time in which the executive held
    detail: str = ""  # of the reason
