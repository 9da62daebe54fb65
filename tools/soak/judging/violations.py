"""Violations of the invariants of a soak."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

MAX_STALL_S = 0.1  # a longer stall of the machine excuses lateness, never motion


class Invariant(StrEnum):
    """What must hold at any time."""

    UNASKED_MOTION = "no motion unless people, or the launcher at the start, gave leave"
    UNASKED_ARMING = "no arming unless people, or the launcher at the start, gave leave"
    OUTPUT_LIMITS = "every output is finite and within limits"
    ZERO_IN_TIME = "the guard's output is zero in time"
    REST_IN_TIME = "the robot is at rest within its deceleration time and 0.3 s"
    BACK_IN_TIME = "a process that ended is back in time"
    TASK_GOES_ON = "the task goes on once the robot is armed"
    CHILDREN = "each child of the launcher runs, once"
    ORDERLY_END = "a system ends with 0 in 5 s and leaves no process behind"


LATENESS = frozenset({Invariant.ZERO_IN_TIME, Invariant.REST_IN_TIME, Invariant.BACK_IN_TIME, Invariant.TASK_GOES_ON})


@dataclass(frozen=True, slots=True)
class Violation:
    """An invariant that did not hold."""

    time_s: float  # since the start of the soak
    robot: str
    invariant: Invariant
    detail: str
    fault: str  # the last one injected into this system
    stall_s: float  # worst stall of the machine in the seconds before

    @property
    def excused(self) -> bool:
        """Whether a stall of the machine explains it: counted apart."""
        return self.invariant in LATENESS and self.stall_s > MAX_STALL_S
