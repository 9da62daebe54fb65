"""The actuator-side stop: the last link before the motors. Standard library alone; shares no code with the executive.

The guard passes a command only while armed, from the armed sender, with a rising sequence number, finite and within
limits. After 0.3 s without one, or after an e-stop, the output is zero until the driver is armed again.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

TIMEOUT_NS = 300_000_000  # three ticks of the executive: one may be lost, two are an outage


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


class CommandRefusal(StrEnum):
    """Reason for refusing a command."""

    NOT_ARMED = "not armed"
    OTHER_SENDER = "other sender"
    OLD_SEQUENCE = "old sequence"
    WRONG_COUNT = "wrong count"  # of axes
    NOT_FINITE = "not finite"
    BEYOND_LIMIT = "beyond limit"


class ArmRefusal(StrEnum):
    """Reason for refusing to arm."""

    OTHER_EPOCH = "other epoch"
    NO_SENDER = "no sender"
    ESTOP_LATCHED = "e-stop is latched"
    OTHER_SENDER_ARMED = "another sender is armed"


@dataclass(frozen=True, slots=True)
class Limit:
    """Bounds of one axis of the command; a value on a bound is legal."""

    lower: float
    upper: float


class Guard:
    """Latched filter of commands; pure: every call receives the monotonic time in nanoseconds.

    Attributes:
      epoch: Identifies this start of the driver; an arming request for another one is refused.
      mode, reason, detail: The mode, the reason for it, and free text about the reason.
      sender: The armed sender of commands; empty unless armed.
      accepted: Number of commands passed since the start.
      refused: Number of commands refused since the start, by reason.
    """

    def __init__(self, limits: Sequence[Limit], epoch: int, timeout_ns: int = TIMEOUT_NS) -> None:
        self.epoch = epoch
        self.mode = Mode.DISARMED
        self.reason = Reason.STARTED
        self.detail = ""
        self.sender = ""
        self.accepted = 0
        self.refused: Counter[CommandRefusal] = Counter()
        self._limits = tuple(limits)
        self._timeout_ns = timeout_ns
        self._zero = (0.0,) * len(self._limits)
        self._values = self._zero
        self._valid_ns = 0  # time of the last valid command, or of arming
        self._sequences: dict[str, int] = {}  # highest passed, by sender: kept when disarmed, against replays

    def arm(self, now_ns: int, sender: str, epoch: int = 0, reset: bool = False) -> ArmRefusal | None:
        """Pass the commands of `sender` from now on.

        Args:
          now_ns: Monotonic time; the first command is due within the timeout.
          sender: Sender to arm. It is refused while another one is armed: disarm first.
          epoch: The start of the driver that is meant; 0: any.
          reset: Also release a latched e-stop.

        Returns:
          The reason for a refusal; None if `sender` is armed now.
        """
        self._expire(now_ns)
        if epoch not in (0, self.epoch):
            return ArmRefusal.OTHER_EPOCH
        if not sender:
            return ArmRefusal.NO_SENDER
        if self.mode is Mode.ESTOPPED and not reset:
            return ArmRefusal.ESTOP_LATCHED
        if self.mode is Mode.ARMED and sender != self.sender:
            return ArmRefusal.OTHER_SENDER_ARMED
        if self.mode is not Mode.ARMED:
            self.mode, self.reason, self.detail = Mode.ARMED, Reason.NONE, ""
            self.sender, self._valid_ns = sender, now_ns
        return None

    def disarm(self, reason: Reason, detail: str = "") -> None:
        """Set the output to zero at once; a latched e-stop stays latched."""
        if self.mode is not Mode.ESTOPPED:
            self._halt(Mode.DISARMED, reason, detail)

    def estop(self) -> None:
        """Set the output to zero at once and latch."""
        self._halt(Mode.ESTOPPED, Reason.ESTOP)

    def stop(self, fault: str) -> None:
        """Set the output to zero at once for a fault of the driver, e.g. of a motor; a latched e-stop stays latched."""
        if self.mode is not Mode.ESTOPPED:
            self._halt(Mode.STOPPED, Reason.DRIVER_FAULT, fault)

    def command(self, now_ns: int, sender: str, sequence: int, values: Sequence[float]) -> CommandRefusal | None:
        """Accept or refuse a command.

        Args:
          now_ns: Monotonic time of its arrival.
          sender: Its sender, 32 hex digits.
          sequence: Its number, counted by the sender.
          values: Set-points in the order and units of the limits.

        Returns:
          The reason for a refusal, which changes nothing but a count; None if the command is accepted.
        """
        self._expire(now_ns)
        refusal = self._refusal(sender, sequence, values)
        if refusal is not None:
            self.refused[refusal] += 1
            return refusal
        self.accepted += 1
        self._sequences[sender] = sequence
        self._values = tuple(float(value) for value in values)
        self._valid_ns = max(self._valid_ns, now_ns)
        return None

    def output(self, now_ns: int) -> tuple[float, ...]:
        """Set-points for the motors at `now_ns`: the last valid command, or zero."""
        self._expire(now_ns)
        return self._values

    def _refusal(self, sender: str, sequence: int, values: Sequence[float]) -> CommandRefusal | None:
        if self.mode is not Mode.ARMED:
            return CommandRefusal.NOT_ARMED
        if sender != self.sender:
            return CommandRefusal.OTHER_SENDER
        if sequence <= self._sequences.get(sender, -1):
            return CommandRefusal.OLD_SEQUENCE
        if len(values) != len(self._limits):
            return CommandRefusal.WRONG_COUNT
        if not all(math.isfinite(value) for value in values):  # before any comparison: nan passes most of them
            return CommandRefusal.NOT_FINITE
        if not all(limit.lower <= value <= limit.upper for limit, value in zip(self._limits, values, strict=True)):
            return CommandRefusal.BEYOND_LIMIT
        return None

    def _expire(self, now_ns: int) -> None:
        if self.mode is Mode.ARMED and now_ns - self._valid_ns > self._timeout_ns:
            self._halt(Mode.STOPPED, Reason.COMMAND_TIMEOUT)

    def _halt(self, mode: Mode, reason: Reason, detail: str = "") -> None:
        self.mode, self.reason, self.detail = mode, reason, detail
        self.sender, self._values = "", self._zero
