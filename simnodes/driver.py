"""The half of the driver contract that every robot shares: bus messages in, guarded set-points and driver state out.

A sim node and a hardware driver both use it; it knows no body, no clock and no bus.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tailor.schemas.messages import ArmRequest, DriverState, EStop, JointCommand, Message, Sample, VelocityCommand
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Guard, Mode

STATE_PERIOD_NS = 100_000_000  # driver state: 10 Hz and on change
TOPICS = ("arm_request", "estop")  # that every driver listens to, besides its command


class Driver:
    """Feeds a guard from the bus and tells what it does."""

    def __init__(self, declared: DriverSpec, epoch: int) -> None:
        """`epoch` must be another one at every start, and not 0."""
        self.guard = Guard(declared.limits, epoch, declared.timeout_ns)
        self._axes = declared.axes
        self._told: tuple[Mode, str] | None = None
        self._tell_at_ns = 0
        self._rejected: dict[str, int] = {}

    def take(self, samples: Iterable[Sample], rejected: dict[str, int], now_ns: int) -> None:
        """Act on what arrived, stops before everything else: an e-stop beats an arming request of the same moment.

        Args:
          samples: Commands, arming requests and e-stops.
          rejected: Undecodable bytes on these topics since start, by reason; they only show in the driver state.
          now_ns: Monotonic time, not before any arrival.
        """
        waiting = sorted(samples, key=lambda sample: (not isinstance(sample.message, EStop), sample.arrival_ns))
        for sample in waiting:
            message = sample.message
            if isinstance(message, EStop):
                if message.stop:
                    self.guard.estop()
            elif isinstance(message, ArmRequest):
                self._arm(message, sample.sender, now_ns)
            else:
                self.guard.command(
                    sample.arrival_ns, sample.sender, sample.sequence, command_values(message, self._axes)
                )
        self._rejected = rejected

    def state(self, now_ns: int, stamp_ns: int) -> DriverState | None:
        """What to publish now, or None: at 10 Hz, and at once when mode or reason change."""
        seen = (self.guard.mode, self.guard.reason)
        if seen == self._told and now_ns < self._tell_at_ns:
            return None
        self._told = seen
        due_ns = self._tell_at_ns + STATE_PERIOD_NS  # from due time to due time, or the node's turns slow it down
        self._tell_at_ns = due_ns if due_ns > now_ns else now_ns + STATE_PERIOD_NS
        guard = self.guard
        refused = {reason.value: count for reason, count in guard.refused.items()} | self._rejected
        return DriverState(
            stamp_ns=stamp_ns,
            mode=guard.mode.value,
            reason=guard.reason,
            epoch=guard.epoch,
            armed_sender=guard.sender,
            accepted=guard.accepted,
            refused_reasons=tuple(refused),
            refused_counts=tuple(refused.values()),
        )

    def _arm(self, request: ArmRequest, sender: str, now_ns: int) -> None:
        if request.arm:
            self.guard.arm(now_ns, request.sender or sender, request.epoch, request.reset)
        elif request.epoch in (0, self.guard.epoch):
            self.guard.disarm(f"disarmed by {(sender or 'somebody')[:8]}")


def command_values(message: Message, axes: Sequence[str]) -> tuple[float, ...]:
    """The set-points in a command, in the order of the driver's axes; empty, so refused, for other messages."""
    if isinstance(message, VelocityCommand):
        return (message.v, message.omega)
    if isinstance(message, JointCommand) and sorted(message.names) == sorted(axes):
        named = dict(zip(message.names, message.velocities, strict=False))
        return tuple(named[axis] for axis in axes if axis in named)
    return ()
