"""Why a guard is in its mode, and why it refuses: listed in docs/reasons.md. Standard library alone."""

from __future__ import annotations

from enum import StrEnum


class Mode(StrEnum):
    """Mode of the guard."""

    DISARMED = "disarmed"  # since start or by request
    ARMED = "armed"  # passes the commands of one sender
    STOPPED = "stopped"  # by itself, see its reason
    ESTOPPED = "estopped"  # latched; only a reset leaves it


class Reason(StrEnum):
    """Reason for the guard's mode."""

    NONE = ""  # armed
    STARTED = "just started"
    DISARM_REQUEST = "disarm request"  # detail: the sender
    WORLD_RESET = "the world was reset"  # simulators only
    SHUTDOWN = "the driver ends"
    COMMAND_TIMEOUT = "no valid command in time"
    DRIVER_FAULT = "driver fault"  # detail: the fault
    ESTOP = "e-stop"
    HOLD_RELEASED = "the dead man's switch was released"  # detail: its sender, first 8 digits


class CommandRefusal(StrEnum):
    """Reason for refusing a command."""

    NOT_ARMED = "not armed"
    OTHER_SENDER = "other sender"
    OLD_SEQUENCE = "old sequence"
    SEQUENCE_JUMP = "sequence jump"
    LATE = "late"
    FROM_THE_FUTURE = "from the future"
    WRONG_COUNT = "wrong count"  # of axes
    NOT_FINITE = "not finite"
    BEYOND_LIMIT = "beyond limit"


class ArmRefusal(StrEnum):
    """Reason for refusing to arm."""

    OTHER_EPOCH = "other epoch"
    NO_SENDER = "no sender"
    ESTOP_LATCHED = "e-stop is latched"
    PEOPLE_ONLY = "only people may arm"
    OTHER_SENDER_ARMED = "another sender is armed"
    NOT_READY = "the hardware is not ready"  # detail of the driver's state: why


class HoldRefusal(StrEnum):
    """Reason for not counting on a dead man's switch."""

    TOO_MANY = "too many switches"
    OLD_SEQUENCE = "old sequence"
