"""Who may arm a driver, and what revokes that: one table of transitions. Standard library alone; pure.

Software may arm a driver once: the executive that the launcher named when it started both (its leave). Every other
arming comes from people. Whatever stops or disarms the robot revokes the leave. A restarted driver has none.
"""

from __future__ import annotations

from enum import Enum


class Arming(Enum):
    """What a driver remembers of its arming since power-on."""

    EXPECTING = "expecting its executive"  # never armed; the launcher gave one executive leave to arm it
    NEVER_ARMED = "never armed"
    ARMED = "armed"
    STOPPED = "stopped"  # by its own guard, or by its hardware
    DISARMED = "disarmed"
    ESTOPPED = "e-stopped"


class Cause(Enum):
    """What can change it."""

    LEAVE = "armed by the executive that has leave"
    PEOPLE = "armed by people"
    RESET = "armed by people, with a reset"
    DISARM = "disarmed"
    STOP = "stopped"
    ESTOP = "e-stop"


_NOT_LATCHED = (Arming.EXPECTING, Arming.NEVER_ARMED, Arming.ARMED, Arming.STOPPED, Arming.DISARMED)

# What is not in this table is refused and changes nothing.
TRANSITIONS: dict[tuple[Arming, Cause], Arming] = {
    (Arming.EXPECTING, Cause.LEAVE): Arming.ARMED,
    **{(state, Cause.PEOPLE): Arming.ARMED for state in _NOT_LATCHED},
    **{(state, Cause.RESET): Arming.ARMED for state in Arming},
    **{(state, Cause.DISARM): Arming.DISARMED for state in _NOT_LATCHED},
    **{(state, Cause.STOP): Arming.STOPPED for state in _NOT_LATCHED},
    **{(state, Cause.ESTOP): Arming.ESTOPPED for state in Arming},
}


def next_arming(state: Arming, cause: Cause) -> Arming | None:
    """The state that follows, or None if the cause is refused in this state."""
    return TRANSITIONS.get((state, cause))
