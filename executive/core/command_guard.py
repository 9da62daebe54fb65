"""Clamps commands to the axis limits and rejects non-finite values.

The driver's guard checks again; for independence the two share no code.
"""

from __future__ import annotations

import math

from tailor.executive.core.reasons import Cause, Reason
from tailor.executive.interfaces.domain import Axis


def at_rest(axes: tuple[Axis, ...]) -> tuple[float, ...]:
    """The command that brings the robot to rest."""
    return tuple(0.0 for _ in axes)


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
