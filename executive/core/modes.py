"""Modes of the executive and the table of their transitions."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Mode(StrEnum):
    """Mode of the executive; only EXECUTING moves the robot."""

    DISARMED = "DISARMED"  # the driver does not obey us
    READY = "READY"  # armed, no active goal
    EXECUTING = "EXECUTING"
    HOLDING = "HOLDING"  # zero command until the cause ends; the plan is kept
    FAULT = "FAULT"  # latched: only a new goal leaves it


@dataclass(frozen=True, slots=True)
class Conditions:
    """One snapshot of all that decides the mode; an empty string means that the condition does not hold."""

    fault: str = ""
    disarmed: str = ""
    hold: str = ""
    goal_active: bool = False


def next_mode(mode: Mode, now: Conditions) -> tuple[Mode, str]:
    """The mode that follows from the present one and a snapshot of conditions, with the reason for it.

    The rows stand in order of precedence; the first that applies decides.
    """
    rows: tuple[tuple[bool, Mode, str], ...] = (
        (bool(now.fault), Mode.FAULT, now.fault),
        (mode is Mode.FAULT, Mode.FAULT, ""),
        (bool(now.disarmed), Mode.DISARMED, now.disarmed),
        (bool(now.hold) and now.goal_active, Mode.HOLDING, now.hold),
        (now.goal_active, Mode.EXECUTING, ""),
    )
    for applies, following, reason in rows:
        if applies:
            return following, reason
    return Mode.READY, ""
