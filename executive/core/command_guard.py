"""Clamps commands to the axis limits and rejects non-finite values, and what is no result of a controller at all.

The driver's guard checks again; for independence the two share no code.
"""

from __future__ import annotations

import math
from typing import Any, get_args

from tailor.executive.interfaces.action import Action, Control, Outcome
from tailor.executive.interfaces.domain import Axis, Domain
from tailor.executive.interfaces.outlet import Command, at_rest, completed, driven_axes
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.results import is_row_of_numbers
from tailor.schemas.parsed_files import shown

OUTCOMES = get_args(Outcome)


def whole_command(domain: Domain, action: Action, command: Command, last: Command) -> tuple[Command, Cause | None]:
    """The checked command of all axes: those that the action does not drive rest; after a rejection all do."""
    driven, rejection = checked(command, driven_axes(domain, action))
    if rejection is not None:
        return at_rest(domain.axes, last), rejection
    return completed(domain, action, driven, last), None


def checked(command: tuple[float, ...], axes: tuple[Axis, ...]) -> tuple[tuple[float, ...], Cause | None]:
    """The command clamped to the axis limits, and the cause of a rejection (None if there is none).

    A rejected command is replaced by zero. Finiteness is tested first: in Python `max(-.5, min(.5, nan))` is .5, full
    speed ahead.
    """
    zero = at_rest(axes)
    if len(command) != len(axes):
        return zero, Cause(Reason.COMMAND_INVALID, f"{len(command)} values for {len(axes)} axes")
    for value, axis in zip(command, axes, strict=True):
        if not math.isfinite(value):
            return zero, Cause(Reason.COMMAND_INVALID, f"{axis.name} is {value}")
    return tuple(min(a.upper, max(a.lower, c)) for c, a in zip(command, axes, strict=True)), None


def fault_of_control(control: Any) -> str:
    """What of a controller's result is of another type than declared, and what is expected; empty if nothing is.

    Unchecked, an outcome that is none ends the action as done, and any other mistake shows up in code of ours.
    """
    if not isinstance(control, Control):
        return f"{shown(control)}, expected a Control (executive/interfaces/action.py)"
    if not isinstance(control.outcome, str) or control.outcome not in OUTCOMES:
        return f"the outcome {shown(control.outcome)}, expected one of: {', '.join(OUTCOMES)}"
    if not is_row_of_numbers(control.command):
        return f"the command {shown(control.command)}, expected a tuple of numbers"
    return "" if isinstance(control.detail, str) else f"the detail {shown(control.detail)}, expected text"
