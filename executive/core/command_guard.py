"""Clamps commands to the axis limits and rejects non-finite values.

The driver's guard checks again; for independence the two share no code.
"""

from __future__ import annotations

import math

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, Domain
from tailor.executive.interfaces.outlet import Command, at_rest, completed, driven_axes
from tailor.executive.interfaces.reasons import Cause, Reason


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
