"""The actuator-side stop: the last link before the motors. Standard library alone; shares no code with the executive.

The guard passes a command only while armed, from the armed sender, with a rising sequence number, finite and within
limits. After 0.3 s without one, or after an e-stop, the output is zero until the driver is armed again.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from tailor.simnodes.arming import Arming, Cause, next_arming
from tailor.simnodes.reasons import ArmRefusal, CommandRefusal, Mode, Reason
from tailor.simnodes.stamps import Stamps

__all__ = ["ArmRefusal", "CommandRefusal", "Guard", "Limit", "Mode", "Reason"]

TIMEOUT_NS = 300_000_000  # three ticks of the executive: one may be lost, two are an outage
MAX_JUMP = 100  # sequence numbers from one command to the next; the timeout lets no sender below 300 Hz miss as many


MODES = {
    Arming.EXPECTING: Mode.DISARMED,
    Arming.NEVER_ARMED: Mode.DISARMED,
    Arming.ARMED: Mode.ARMED,
    Arming.STOPPED: Mode.STOPPED,
    Arming.DISARMED: Mode.DISARMED,
    Arming.ESTOPPED: Mode.ESTOPPED,
}


@dataclass(frozen=True, slots=True)
class Limit:
    """Bounds of one axis of the command; a value on a bound is legal.

    `kept` is the first set-point of an axis that keeps its last one when the guard stops, such as the width of a
    gripper: opening it would drop what it holds. None: zero stops the axis.
    """

    lower: float
    upper: float
    kept: float | None = None


class Guard:
    """Latched filter of commands; pure: every call receives the monotonic time in nanoseconds.

    "Zero" is the set-point that stops an axis; an axis that is kept keeps its last one.

    Attributes:
      epoch: Identifies this start of the driver; an arming request for another one is refused.
      arming: State of the arming, see arming.py; the mode follows from it.
      reason, detail: The reason for the mode, and free text about the reason.
      sender: The armed sender of commands; empty unless armed.
      accepted: Number of commands passed since the start.
      refused: Number of commands refused since the start, by reason.
      command_stamp_ns: Stamp of the newest command passed since arming, by its sender's clock; 0: none, or unknown.
    """

    def __init__(self, limits: Sequence[Limit], epoch: int, timeout_ns: int = TIMEOUT_NS, leave: str = "") -> None:
        """Start disarmed.

        Args:
          limits: Limits of the axes, in the order of the command's values.
          epoch: Identifies this start; different at every start, and not 0.
          timeout_ns: The output is zero this long after the last valid command.
          leave: Sender id of the program that may arm the driver by itself, once; empty: only people may.
        """
        self.epoch = epoch
        self.arming = Arming.EXPECTING if leave else Arming.NEVER_ARMED
        self.reason = Reason.STARTED
        self.detail = ""
        self.sender = ""
        self.accepted = 0
        self.refused: Counter[CommandRefusal] = Counter()
        self.command_stamp_ns = 0
        self._leave = leave
        self._limits = tuple(limits)
        self._timeout_ns = timeout_ns
        self._values = tuple(0.0 if limit.kept is None else limit.kept for limit in self._limits)
        self._valid_ns = 0  # time of the last valid command, or of arming
        self._sequences: dict[str, int] = {}  # highest passed, by sender: kept when disarmed, against replays
        self._stamps: Stamps | None = None  # of the armed sender; None: no command since arming

    @property
    def mode(self) -> Mode:
        """Mode of the guard."""
        return MODES[self.arming]

    def arm(
        self, now_ns: int, sender: str, epoch: int = 0, reset: bool = False, by_people: bool = True
    ) -> ArmRefusal | None:
        """Pass the commands of `sender` from now on.

        Args:
          now_ns: Monotonic time; the first command is due within the timeout.
          sender: Sender to arm. It is refused while another one is armed: disarm first.
          epoch: The start of the driver that is meant; 0: any.
          reset: Also release a latched e-stop; only people may.
          by_people: False for a program that arms itself; it needs the leave.

        Returns:
          The reason for a refusal; None if `sender` is armed now.
        """
        self._expire(now_ns)
        if epoch not in (0, self.epoch):
            return ArmRefusal.OTHER_EPOCH
        if not sender:
            return ArmRefusal.NO_SENDER
        if self.mode is Mode.ARMED:
            return None if sender == self.sender else ArmRefusal.OTHER_SENDER_ARMED
        return self._arm(now_ns, sender, reset, by_people)

    def disarm(self, reason: Reason, detail: str = "") -> None:
        """Set the output to zero at once; a latched e-stop stays latched."""
        self._halt(Cause.DISARM, reason, detail)

    def estop(self, reason: Reason = Reason.ESTOP, detail: str = "") -> None:
        """Set the output to zero at once and latch."""
        self._halt(Cause.ESTOP, reason, detail)

    def stop(self, fault: str) -> None:
        """Set the output to zero at once for a fault of the driver, e.g. of a motor; a latched e-stop stays latched."""
        self._halt(Cause.STOP, Reason.DRIVER_FAULT, fault)

    def command(
        self, now_ns: int, sender: str, sequence: int, values: Sequence[float], stamp_ns: int = 0, lag_ns: int = 0
    ) -> CommandRefusal | None:
        """Accept or refuse a command.

        Args:
          now_ns: Monotonic time of its arrival.
          sender: Its sender, 32 hex digits.
          sequence: Its number, counted by the sender.
          values: Set-points in the order and units of the limits.
          stamp_ns: Time of its creation by the sender's clock; 0: unknown, it is not judged, see stamps.py.
          lag_ns: `now_ns` is this much behind real time, in which stamps are judged, e.g. in a paused simulator.

        Returns:
          The reason for a refusal, which changes nothing but a count; None if the command is accepted.
        """
        self._expire(now_ns)
        stamps = self._stamps or Stamps()
        refusal = self._refusal(sender, sequence, values) or stamps.refusal(now_ns + lag_ns, stamp_ns)
        if refusal is not None:
            self.refused[refusal] += 1
            return refusal
        self.accepted += 1
        self._sequences[sender] = sequence
        self.command_stamp_ns = stamp_ns
        self._values = tuple(float(value) for value in values)
        self._valid_ns = max(self._valid_ns, now_ns)
        self._stamps = stamps
        stamps.accept(now_ns + lag_ns, stamp_ns)
        return None

    def output(self, now_ns: int) -> tuple[float, ...]:
        """Set-points for the motors at `now_ns`: the last valid command, or zero."""
        self._expire(now_ns)
        return self._values

    def keep(self, values: Sequence[float]) -> None:
        """Take the set-points at which axes that keep theirs stay where they are; ignored while armed.

        Args:
          values: One for each axis; only those of axes that are kept count, and only within their limits.
        """
        if self.mode is not Mode.ARMED:
            rows = zip(self._limits, values, self._values, strict=True)
            self._values = tuple(
                float(now) if limit.kept is not None and limit.lower <= now <= limit.upper else before
                for limit, now, before in rows
            )

    def _arm(self, now_ns: int, sender: str, reset: bool, by_people: bool) -> ArmRefusal | None:
        if not by_people and sender != self._leave:
            return ArmRefusal.PEOPLE_ONLY
        cause = (Cause.RESET if reset else Cause.PEOPLE) if by_people else Cause.LEAVE
        following = next_arming(self.arming, cause)
        if following is None:
            return ArmRefusal.ESTOP_LATCHED if self.mode is Mode.ESTOPPED else ArmRefusal.PEOPLE_ONLY
        self.arming, self.reason, self.detail = following, Reason.NONE, ""
        self.sender, self._valid_ns, self._stamps = sender, now_ns, None
        self.command_stamp_ns = 0
        return None

    def _refusal(self, sender: str, sequence: int, values: Sequence[float]) -> CommandRefusal | None:
        if self.mode is not Mode.ARMED:
            return CommandRefusal.NOT_ARMED
        if sender != self.sender:
            return CommandRefusal.OTHER_SENDER
        if sequence <= self._sequences.get(sender, -1):
            return CommandRefusal.OLD_SEQUENCE
        if self._stamps is not None and sequence > self._sequences[sender] + MAX_JUMP:
            return CommandRefusal.SEQUENCE_JUMP  # one forged number must not lock the true sender out
        if len(values) != len(self._limits):
            return CommandRefusal.WRONG_COUNT
        if not all(math.isfinite(value) for value in values):  # before any comparison: nan passes most of them
            return CommandRefusal.NOT_FINITE
        if not all(limit.lower <= value <= limit.upper for limit, value in zip(self._limits, values, strict=True)):
            return CommandRefusal.BEYOND_LIMIT
        return None

    def _expire(self, now_ns: int) -> None:
        if self.mode is Mode.ARMED and now_ns - self._valid_ns > self._timeout_ns:
            self._halt(Cause.STOP, Reason.COMMAND_TIMEOUT)

    def _halt(self, cause: Cause, reason: Reason, detail: str = "") -> None:
        following = next_arming(self.arming, cause)
        if following is not None:
            self.arming, self.reason, self.detail = following, reason, detail
            self.sender, self._values = "", self._rest()

    def _rest(self) -> tuple[float, ...]:
        """Zero, or the last set-point of an axis that keeps it."""
        pairs = zip(self._limits, self._values, strict=True)
        return tuple(0.0 if limit.kept is None else value for limit, value in pairs)
