"""The actuator-side stop: the last link before the motors. Standard library alone; shares no code with the executive.

A command is obeyed only while armed, from the sender that was armed, with a rising sequence number, finite and
within limits. 0.3 s without one, or an e-stop, and the output is zero until somebody arms again.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

TIMEOUT_NS = 300_000_000  # three ticks of the executive: one may be lost, two are an outage


class Mode(Enum):
    """What the guard is doing."""

    DISARMED = "disarmed"  # since start, or told so
    ARMED = "armed"  # obeys one sender
    STOPPED = "stopped"  # by itself, see its reason
    ESTOPPED = "estopped"  # latched; only a reset leaves it


class Refusal(Enum):
    """Why a command was not obeyed."""

    NOT_ARMED = "not armed"
    OTHER_SENDER = "other sender"
    OLD_SEQUENCE = "old sequence"
    WRONG_COUNT = "wrong count"
    NOT_FINITE = "not finite"
    BEYOND_LIMIT = "beyond limit"


@dataclass(frozen=True, slots=True)
class Limit:
    """Bounds of one axis of the command; a value on a bound is legal."""

    lower: float
    upper: float


class Guard:
    """Pure: no clock of its own, every call is handed the monotonic time in nanoseconds.

    Attributes:
      epoch: Names this start of the driver; an arming request for another one is refused.
      mode, reason: What the guard is doing, and why.
      sender: Whose commands are obeyed; empty unless armed.
      accepted: Commands obeyed since the start.
      refused: Commands refused since the start, by reason.
    """

    def __init__(self, limits: Sequence[Limit], epoch: int, timeout_ns: int = TIMEOUT_NS) -> None:
        self.epoch = epoch
        self.mode = Mode.DISARMED
        self.reason = "just started"
        self.sender = ""
        self.accepted = 0
        self.refused: Counter[Refusal] = Counter()
        self._limits = tuple(limits)
        self._timeout_ns = timeout_ns
        self._zero = (0.0,) * len(self._limits)
        self._values = self._zero
        self._valid_ns = 0  # time of the last valid command, or of arming
        self._sequences: dict[str, int] = {}  # highest one obeyed, by sender: survives disarming, so no replays

    def arm(self, now_ns: int, sender: str, epoch: int = 0, reset: bool = False) -> str:
        """Obey `sender` from now on; answers why not, or an empty string.

        Args:
          now_ns: Monotonic time; the first command is due within the timeout.
          sender: The one to obey. While another one is armed it is refused: disarm first.
          epoch: The start of the driver that is meant; 0 means whichever.
          reset: Also leave a latched e-stop.
        """
        self._expire(now_ns)
        if epoch not in (0, self.epoch):
            return "other epoch"
        if not sender:
            return "no sender"
        if self.mode is Mode.ESTOPPED and not reset:
            return "e-stop is latched"
        if self.mode is Mode.ARMED and sender != self.sender:
            return "another sender is armed"
        if self.mode is not Mode.ARMED:
            self.mode, self.reason, self.sender, self._valid_ns = Mode.ARMED, "", sender, now_ns
        return ""

    def disarm(self, reason: str = "disarmed") -> None:
        """Zero at once; a latched e-stop stays latched."""
        if self.mode is not Mode.ESTOPPED:
            self._halt(Mode.DISARMED, reason)

    def estop(self, reason: str = "e-stop") -> None:
        """Zero at once and latch."""
        self._halt(Mode.ESTOPPED, reason)

    def stop(self, reason: str) -> None:
        """Zero at once for a reason of the driver's own, e.g. a failed motor; a latched e-stop stays latched."""
        if self.mode is not Mode.ESTOPPED:
            self._halt(Mode.STOPPED, reason)

    def command(self, now_ns: int, sender: str, sequence: int, values: Sequence[float]) -> Refusal | None:
        """Obey a command that arrived at `now_ns`, or refuse it; a refused one changes nothing but a count."""
        self._expire(now_ns)
        refusal = self._judge(sender, sequence, values)
        if refusal is not None:
            self.refused[refusal] += 1
            return refusal
        self.accepted += 1
        self._sequences[sender] = sequence
        self._values = tuple(float(value) for value in values)
        self._valid_ns = max(self._valid_ns, now_ns)
        return None

    def output(self, now_ns: int) -> tuple[float, ...]:
        """What the motors are to do now: the last valid command, or zero."""
        self._expire(now_ns)
        return self._values

    def _judge(self, sender: str, sequence: int, values: Sequence[float]) -> Refusal | None:
        if self.mode is not Mode.ARMED:
            return Refusal.NOT_ARMED
        if sender != self.sender:
            return Refusal.OTHER_SENDER
        if sequence <= self._sequences.get(sender, -1):
            return Refusal.OLD_SEQUENCE
        if len(values) != len(self._limits):
            return Refusal.WRONG_COUNT
        if not all(math.isfinite(value) for value in values):  # before any comparison: nan passes most of them
            return Refusal.NOT_FINITE
        if not all(limit.lower <= value <= limit.upper for limit, value in zip(self._limits, values, strict=True)):
            return Refusal.BEYOND_LIMIT
        return None

    def _expire(self, now_ns: int) -> None:
        if self.mode is Mode.ARMED and now_ns - self._valid_ns > self._timeout_ns:
            self._halt(Mode.STOPPED, "no valid command in time")

    def _halt(self, mode: Mode, reason: str) -> None:
        self.mode, self.reason, self.sender, self._values = mode, reason, "", self._zero
