"""The half of the driver contract that every robot shares: bus messages in, guarded set-points and driver state out.

A sim node and a hardware driver both use it; it imports no body, no clock and no bus.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tailor.schemas.messages import ArmRequest, DriverState, EStop, JointCommand, Message, Sample, VelocityCommand
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Guard, Reason

STATE_PERIOD_NS = 100_000_000  # driver state: 10 Hz and on change
SELF_ARM = "self_arm"  # requests of the executive; those of people come on another topic, which it may not write
TOPICS = ("arm_request", SELF_ARM, "estop")  # inputs of every driver besides its command


class Driver:
    """Feeds a guard from the bus and reports its state.

    Attributes:
      guard: The guard; `guard.output(now_ns)` gives the set-points for the motors.
    """

    def __init__(self, spec: DriverSpec, epoch: int, leave: str = "") -> None:
        """Start disarmed.

        Args:
          spec: Command topic, axes, limits and timeout of the driver.
          epoch: Identifies this start; different at every start, and not 0.
          leave: Sender id of the executive that may arm the driver by itself, once; empty: only people may.
        """
        self.guard = Guard(spec.limits, epoch, spec.timeout_ns, leave)
        self._axes = spec.axes
        self._published: tuple[str, str, str] | None = None
        self._due_ns = 0
        self._rejected: Mapping[str, int] = {}

    def take(self, samples: Iterable[Sample], rejected: Mapping[str, int], now_ns: int) -> None:
        """Process received messages; an e-stop wins over every arming request of the same call, earlier or later.

        Args:
          samples: Commands, arming requests and e-stops.
          rejected: Undecodable messages on these topics since start, by reason; only reported in the driver state.
          now_ns: Monotonic time, not before any arrival.
        """
        ordered = sorted(samples, key=lambda sample: sample.arrival_ns)
        stopped = any(isinstance(sample.message, EStop) and sample.message.stop for sample in ordered)
        if stopped:
            self.guard.estop()
        for sample in ordered:
            message = sample.message
            if isinstance(message, ArmRequest):
                if not (stopped and message.arm):
                    self._arm(message, sample, now_ns)
            elif not isinstance(message, EStop):
                values, stamp_ns = command_values(message, self._axes), getattr(message, "stamp_ns", 0)
                self.guard.command(sample.arrival_ns, sample.sender, sample.sequence, values, stamp_ns)
        self._rejected = rejected

    def state(self, now_ns: int, stamp_ns: int) -> DriverState | None:
        """The state if it is due: at 10 Hz, and at once when mode, reason or detail change.

        Args:
          now_ns: Monotonic time.
          stamp_ns: Wall time for the message.
        """
        guard = self.guard
        current = (guard.mode, guard.reason, guard.detail)
        if current == self._published and now_ns < self._due_ns:
            return None
        self._published = current
        next_ns = self._due_ns + STATE_PERIOD_NS  # counted from due time to due time: the node's periods add no delay
        self._due_ns = next_ns if next_ns > now_ns else now_ns + STATE_PERIOD_NS
        refused = {refusal.value: count for refusal, count in guard.refused.items()} | dict(self._rejected)
        return DriverState(
            stamp_ns=stamp_ns,
            mode=guard.mode.value,
            reason=guard.reason.value,
            detail=guard.detail,
            epoch=guard.epoch,
            armed_sender=guard.sender,
            accepted=guard.accepted,
            refused_reasons=tuple(refused),
            refused_counts=tuple(refused.values()),
        )

    def _arm(self, request: ArmRequest, sample: Sample, now_ns: int) -> None:
        by_people = not sample.key.endswith(f"/{SELF_ARM}")
        if request.arm:
            sender = (request.sender if by_people else "") or sample.sender
            self.guard.arm(now_ns, sender, request.epoch, request.reset, by_people)
        elif request.epoch in (0, self.guard.epoch):
            self.guard.disarm(Reason.DISARM_REQUEST, f"by {(sample.sender or 'unknown')[:8]}")


def command_values(message: Message, axes: Sequence[str]) -> tuple[float, ...]:
    """The set-points of a command, in the order of the driver's axes; empty, thus refused, for any other message."""
    if isinstance(message, VelocityCommand):
        return (message.v, message.omega)
    if isinstance(message, JointCommand) and sorted(message.names) == sorted(axes):
        velocities = dict(zip(message.names, message.velocities, strict=False))
        return tuple(velocities[axis] for axis in axes if axis in velocities)
    return ()
