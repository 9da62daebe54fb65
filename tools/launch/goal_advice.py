"""What people can do once an executive pursues no goal any more."""

from __future__ import annotations

from tailor.executive.core.modes import Mode
from tailor.schemas.messages import ExecStatus
from tailor.schemas.reason_text import reason_text


def next_step(status: ExecStatus, result: str) -> str:
    """A line with the command for the next step; empty while the goal is pursued.

    Args:
      status: Of the executive.
      result: Of its task, for people; a fault has none.
    """
    goes_on = f'tailor goal "{status.goal}" pursues a goal; Ctrl-C stops the system'
    if status.mode == Mode.FAULT:
        fault = reason_text(status.mode, reason_text(status.reason, status.detail))
        return f"{fault}. next: remove the cause, then {goes_on}"
    return f"{result}. next: {goes_on}" if result else ""
