"""What the executive does: its state after each tick, and how its actions ended."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class ExecStatus(Message):
    """The executive's state at the end of a tick."""

    stamp_ns: int
    tick: int
    mode: str  # DISARMED READY EXECUTING HOLDING FAULT
    reason: str
    scenario: str
    goal: str
    result: str  # "", "achieved", "failed: why"
    action: str  # e.g. "goToPose", empty between actions
    action_index: int
    action_elapsed_s: float
    action_predicted_s: float
    belief: tuple[float, ...] = ()  # in the order of the domain's belief_names
    sender: str = ""  # this executive's sender id, 32 hex digits


@dataclass(frozen=True, slots=True)
class ActionFinished(Message):
    """One action ended: how, and how long it took against what was predicted."""

    stamp_ns: int
    tick: int
    action: str
    action_index: int
    outcome: str  # "done", "failed", "aborted"
    reason: str
    predicted_s: float
    actual_s: float
