"""Goals that a node sends again and again: all of them are one request, which people may end. Pure.

Each of them would undo a cancellation, and end a fault, in the tick after it.
"""

from __future__ import annotations

from tailor.executive.core.state import State
from tailor.executive.interfaces.reasons import Result

PAUSE_NS = 1_000_000_000  # after which an equal goal is another request


class RepeatedGoals:
    """Follows the goals that are sent to one executive."""

    def __init__(self) -> None:
        self._goal, self._sent_ns = "", 0

    def refusal(self, goal: str, now_ns: int, state: State) -> str:
        """Why a goal that is sent at `now_ns` does not count, in the state before it; empty: it does."""
        again = goal == self._goal and now_ns - self._sent_ns < PAUSE_NS
        self._goal, self._sent_ns = goal, now_ns
        ended = _ended(state)
        if not again or not ended or goal != state.task.goal:
            return ""
        return f"{ended}, and is sent all the time: end its sender, or send it again after {PAUSE_NS / 1e9:g} s"


def is_pursued(goal: str, state: State) -> bool:
    """Whether a goal is the open one: sent again, it changes nothing, or a robot would plan for ever.

    A goal that has ended, or that ends in a fault, is not.
    """
    return state.task.active and state.fault is None and state.task.goal == goal


def _ended(state: State) -> str:
    """What only people may undo of the last goal; empty if nothing is."""
    if state.fault is not None:
        return f"this goal ended in a fault ({state.fault})"
    return "this goal was cancelled" if state.task.result is Result.CANCELLED else ""
