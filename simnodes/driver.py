"""The half of the driver contract that every robot shares: bus messages in, guarded set-points and driver state out.

A sim node and a hardware driver both use it; it imports no body, no clock and no bus.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence

from tailor.schemas.messages import ArmRequest, DriverState, EStop, JointCommand, Message, Sample, VelocityCommand
from tailor.schemas.reason_text import without_numbers
from tailor.schemas.topics import TOPICS as TOPIC_TABLE
from tailor.simnodes.command_parts import CommandParts, Part
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Guard
from tailor.simnodes.hold import HeldSwitches
from tailor.simnodes.reasons import ArmRefusal, Mode, Reason

STATE_PERIOD_NS = 100_000_000  # driver state: 10 Hz and on change
SELF_ARM = "self_arm"  # requests of the executive; those of people come on another topic, which it may not write
# Inputs of every driver besides its command, to be looked at in this order. Were the e-stop the last, a reset and then
# an e-stop that arrive in the midst of a look would be taken the other way round: the reset would release the e-stop.
TOPICS = ("estop", "arm_request", SELF_ARM)
SHOWN_DIGITS = 8  # of a sender id
HELD_BY = "held by "  # in the detail of a driver's state: the dead man's switches that it hears
NOT_READY = "not ready"  # in the detail, with the reason why the hardware cannot be driven, unless it stands before
ARM_REFUSED = "arm: "  # before the reason of a refused arming request, in a driver's state


class Driver:
    """Feeds a guard from the bus and reports its state.

    Attributes:
      guard: The guard; its `output(now_ns)` gives the set-points for the motors, see also `set_points`.
      held: The dead man's switches; when one falls silent, the driver stops and latches.
      unready: Why the hardware cannot be driven now, so that arming is refused; empty: it can.
      notice: What people should know although it can; empty: nothing.
    """

    def __init__(self, spec: DriverSpec, epoch: int, leave: str = "") -> None:
        """Start disarmed.

        Args:
          spec: Command topic, axes, limits and timeout of the driver.
          epoch: Identifies this start; different at every start, and not 0.
          leave: Sender id of the executive that may arm the driver by itself, once; empty: only people may.
        """
        self.guard = Guard(spec.limits, epoch, spec.timeout_ns, leave)
        self.held = HeldSwitches()
        self.unready = self.notice = ""
        self._arm_refused: Counter[ArmRefusal] = Counter()
        self._outlets = tuple((_suffix(TOPIC_TABLE[o.topic].key), o.axes) for o in spec.all_outlets())
        self._numbers = {suffix: number for number, (suffix, _) in enumerate(self._outlets)}
        self._parts = CommandParts([len(axes) for _, axes in self._outlets])
        self._published: tuple[str, str, str] | None = None
        self._due_ns = 0
        self._rejected: Mapping[str, int] = {}

    def take(self, samples: Iterable[Sample], rejected: Mapping[str, int], now_ns: int, guard_lag_ns: int = 0) -> None:
        """Process received messages; call it in every period, also without any: silence is a message of its own.

        An e-stop wins over every arming request of the same call, earlier or later.

        Args:
          samples: Commands, arming requests and e-stops.
          rejected: Undecodable messages on these topics since start, by reason; only reported in the driver state.
          now_ns: Monotonic time, not before any arrival.
          guard_lag_ns: The guard's clock is this much behind, e.g. since a simulator was paused; a dead man's switch
            is always held in real time.
        """
        ordered = sorted(samples, key=lambda sample: sample.arrival_ns)
        stopped = self._estop(ordered, now_ns)
        for sample in ordered:
            message = sample.message
            if isinstance(message, ArmRequest):
                refusal = self._arm(message, sample, now_ns - guard_lag_ns, stopped)
                if refusal is not None:
                    self._arm_refused[refusal] += 1
            elif not isinstance(message, EStop):
                arrival_ns = sample.arrival_ns - guard_lag_ns
                for whole in self._parts.join(self._part(sample), sample.sender, self.guard.sender):
                    command = (whole.sequence, whole.values, whole.stamp_ns)
                    self.guard.command(arrival_ns, sample.sender, *command, guard_lag_ns)
        self._rejected = rejected

    def set_points(self, now_ns: int, kept: Callable[[], Sequence[float]] | None) -> tuple[float, ...]:
        """Set-points for the motors; an axis that is kept stays where it is, unless the driver is armed.

        It would otherwise go on to its last set-point after an e-stop, and before anybody has armed the driver.

        Args:
          now_ns: Monotonic time.
          kept: Set-points at which such axes stay where they are, see Body; None: unknown, or there are none.
        """
        values = self.guard.output(now_ns)
        if kept is None or self.guard.mode is Mode.ARMED:
            return values
        self.guard.keep(kept())
        return self.guard.output(now_ns)

    def state(self, now_ns: int, stamp_ns: int) -> DriverState | None:
        """The state if it is due: at 10 Hz, and at once when mode, reason or detail (but a number of a notice) change.

        Args:
          now_ns: Monotonic time.
          stamp_ns: Wall time for the message.
        """
        guard = self.guard
        current = (guard.mode, guard.reason, self._detail(without_numbers(self.notice)))  # a voltage changes always
        if current == self._published and now_ns < self._due_ns:
            return None
        self._published = current
        if now_ns >= self._due_ns:  # a change in between moves no due time: a few of them would silence the driver
            next_ns = self._due_ns + STATE_PERIOD_NS  # from due time to due time: the node's periods add no delay
            self._due_ns = next_ns if next_ns > now_ns else now_ns + STATE_PERIOD_NS
        refused = self._refused()
        return DriverState(
            stamp_ns=stamp_ns,
            mode=guard.mode.value,
            reason=guard.reason.value,
            detail=self._detail(self.notice),
            epoch=guard.epoch,
            armed_sender=guard.sender,
            accepted=guard.accepted,
            refused_reasons=tuple(refused),
            refused_counts=tuple(refused.values()),
            command_stamp_ns=guard.command_stamp_ns,
        )

    def _part(self, sample: Sample) -> Part:
        """The set-points of one outlet: that of the sample's key, or the only one."""
        outlet = self._numbers.get(_suffix(sample.key), 0)
        message = sample.message
        values, stamp_ns = command_values(message, self._outlets[outlet][1]), getattr(message, "stamp_ns", 0)
        return Part(outlet, sample.sequence, values, stamp_ns)

    def _detail(self, notice: str) -> str:
        held = ", ".join(shown(sender) for sender in self.held.senders)
        parts = self.guard.detail, self._why_unready(), notice, f"{HELD_BY}{held}" if held else ""
        return "; ".join(text for text in parts if text)

    def _why_unready(self) -> str:
        """Empty if the hardware is ready. The guard's detail alone does not tell: it outlasts the fault."""
        if self.unready in ("", self.guard.detail):
            return NOT_READY if self.unready else ""
        return f"{NOT_READY}: {self.unready}"

    def _refused(self) -> dict[str, int]:
        """Number of refused messages since start, by reason; arming requests and switches with a prefix."""
        commands = {refusal.value: count for refusal, count in self.guard.refused.items()}
        arming = {f"{ARM_REFUSED}{refusal.value}": count for refusal, count in self._arm_refused.items()}
        switches = {f"hold: {refusal.value}": count for refusal, count in self.held.refused.items()}
        return commands | arming | switches | dict(self._rejected)

    def _estop(self, samples: Sequence[Sample], now_ns: int) -> bool:
        """Stop and latch if an e-stop requests it or a dead man's switch was released; whether one of them did."""
        requested = False
        for sample in samples:
            if isinstance(sample.message, EStop):
                requested = requested or sample.message.stop
                if not sample.message.stop:
                    self.held.hold(sample.sender, sample.sequence, sample.arrival_ns)
        released = self.held.released(now_ns)
        if requested:
            self.guard.estop()
        elif released and self.guard.mode is not Mode.ESTOPPED:  # keep the first reason
            self.guard.estop(Reason.HOLD_RELEASED, ", ".join(map(shown, released)))
        return requested or bool(released)

    def _arm(self, request: ArmRequest, sample: Sample, now_ns: int, stopped: bool) -> ArmRefusal | None:
        if not request.arm:
            if request.epoch not in (0, self.guard.epoch):
                return ArmRefusal.OTHER_EPOCH
            self.guard.disarm(Reason.DISARM_REQUEST, f"by {shown(sample.sender)}")
            return None
        if stopped:
            return ArmRefusal.ESTOP_LATCHED
        if self.unready:
            return ArmRefusal.NOT_READY
        by_people = not sample.key.endswith(f"/{SELF_ARM}")
        sender = (request.sender if by_people else "") or sample.sender
        self.guard.output(now_ns)  # so that one whose command is overdue has stopped
        mode = self.guard.mode
        refusal = self.guard.arm(now_ns, sender, request.epoch, request.reset, by_people)
        if refusal is None and mode is not Mode.ARMED:
            self._parts.forget()  # half a command from before would be completed, and then be no older than its rest
        if refusal is None and mode is Mode.ESTOPPED:
            self.held.forget()  # people have taken over; who still holds a switch is heard again within 0.1 s
        return refusal


def shown(sender: str) -> str:
    """Short form of a sender id in a detail."""
    return sender[:SHOWN_DIGITS] or "unknown"


def _suffix(key: str) -> str:
    """A topic's key without the robot."""
    return key.partition("/")[2]


def command_values(message: Message, axes: Sequence[str]) -> tuple[float, ...]:
    """The set-points of a command, in the order of the driver's axes; empty, thus refused, for any other message.

    A message of a robot's own package has a field for each axis, of its name.
    """
    if isinstance(message, VelocityCommand):
        return (message.v, message.omega)
    if isinstance(message, JointCommand) and sorted(message.names) == sorted(axes):
        velocities = dict(zip(message.names, message.velocities, strict=False))
        return tuple(velocities[axis] for axis in axes if axis in velocities)
    values = [getattr(message, axis, None) for axis in axes]
    return tuple(value for value in values if isinstance(value, float)) if None not in values else ()
