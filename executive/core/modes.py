"""Modes of the executive and the table of their transitions."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from tailor.executive.interfaces.reasons import Cause


class Mode(StrEnum):
    """Mode of the executive; only EXECUTING moves the robot."""

    DISARMED = "DISARMED"  # the driver does not obey us
    READY = "READY"  # armed, no active goal
    EXECUTING = "EXECUTING"
    HOLDING = "HOLDING"  # zero command until the cause ends; the plan is kept
    FAULT = "FAULT"  # latched: only a new goal leaves it


@dataclass(frozen=True, slots=True)
class Conditions:
    """Conditions that decide the mode, from one snapshot; None: the condition does not hold."""

    fault: Cause | None = None
    disarmed: Cause | None = None
    hold: Cause | None = None
    goal_active: bool = False


def next_mode(mode: Mode, now: Conditions) -> tuple[Mode, Cause | None]:
    """The mode that follows from the present one and a snapshot of conditions, with its cause.

    The rows stand in order of precedence; the first that applies decides.
    """
    rows: tuple[tuple[bool, Mode, Cause | None], ...] = (
        (now.fault is not None, Mode.FAULT, now.fault),
        (mode is Mode.FAULT, Mode.FAULT, None),
        (now.disarmed is not None, Mode.DISARMED, now.disarmed),
        (now.hold is not None and now.goal_active, Mode.HOLDING, now.hold),
        (now.goal_active, Mode.EXECUTING, None),
    )
    for applies, following, cause in rows:
        if applies:
            return following, cause
    return Mode.READY, None
