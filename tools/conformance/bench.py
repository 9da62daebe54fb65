"""A driver under test: what it publishes, and ways to arm, command and stop it. Clauses use nothing else."""

from __future__ import annotations

import itertools
import re
import secrets
from collections import Counter
from collections.abc import Iterator, Sequence

from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import at_rest, messages_of
from tailor.runtime.bus.attachment import Origin
from tailor.schemas.messages import ArmRequest, DriverState, EStop
from tailor.simnodes.driver import SHOWN_DIGITS, shown
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit
from tailor.simnodes.reasons import Reason
from tailor.tools.conformance.link import Heard, Link, speed_in

PERIOD_S = 0.1  # of commands, as an executive sends them
SETTLE_S = 0.3  # until a request or a command shows in the driver's state and in its sensors
PATIENCE_S = 6.0  # for the robot to come to rest
SENDER = re.compile(rf"\b[0-9a-f]{{{SHOWN_DIGITS}}}\b")  # of a switch, in the detail of a driver's state
BLIND_S = 0.5  # without a measurement for so long nobody knows whether the robot moves
FRESH_S = 1.0  # ten periods of the driver's state: an older one is that of a driver which has ended


class NotPossible(Exception):
    """A clause cannot be tried since something that it needs does not work; another clause reports that."""


class EStopPressed(Exception):
    """Somebody else stopped all drivers: the bench, which resets the e-stops that it sends, must not reset this one."""


class Bench:
    """One driver under test.

    Attributes:
      domain, spec: What is declared of the robot and of its driver.
      fraction: Speeds of the test, as a fraction of the limits.
      log: All that was heard.
      sent: Number of valid commands of the armed sender.
      sender, other: Two senders; only the first one is ever armed with good reason.
    """

    def __init__(self, link: Link, domain: Domain, spec: DriverSpec, fraction: float) -> None:
        self.link, self.domain, self.spec, self.fraction = link, domain, spec, fraction
        self.log: list[Heard] = []
        self.sent = 0
        self.sender, self.other = secrets.token_hex(16), secrets.token_hex(16)
        self._numbers: Counter[str] = Counter()
        self._shown: set[int] = set()  # axes that sensors have shown
        self._before: set[str] | None = None  # dead man's switches that were let go before

    def wait(self, seconds: float) -> None:
        """Listen.

        Raises:
          EStopPressed: An e-stop of somebody else was heard, or has shown in the driver's state.
        """
        heard = self.link.wait(seconds)
        self.log += heard
        if any(map(self._is_of_people, heard)):
            raise EStopPressed("somebody pressed the e-stop, or let go of a dead man's switch")

    def _is_of_people(self, heard: Heard) -> bool:
        message = heard.message
        if isinstance(message, EStop):
            return message.stop and heard.sender != self.other
        if not isinstance(message, DriverState):
            return False
        is_released = message.reason == Reason.HOLD_RELEASED
        switches = set(SENDER.findall(message.detail.partition(";")[0])) if is_released else set[str]()
        self._before = switches if self._before is None else self._before & switches
        return bool(switches - self._before - {shown(self.other)})

    def heard(self, topic: str, since_s: float = 0.0) -> list[Heard]:
        """What was heard of a topic since a time."""
        recent = itertools.takewhile(lambda each: each.at_s >= since_s, reversed(self.log))
        return [each for each in recent if each.topic == topic][::-1]

    def state(self) -> DriverState:
        """The driver's newest state.

        Raises:
          NotPossible: There is none of the last second, nor within another one.
        """
        for _ in range(10):
            for each in reversed(self.heard("driver", self.link.now_s() - FRESH_S)):
                if isinstance(each.message, DriverState):
                    return each.message
            self.wait(PERIOD_S)
        raise NotPossible("it publishes no state")

    def settled_state(self) -> DriverState:
        """The driver's state once everything that was sent has had its effect."""
        self.wait(SETTLE_S)
        return self.state()

    def request(self, arm: bool = True, sender: str = "", epoch: int = 0, reset: bool = False) -> None:
        """Request to arm or disarm, as people do."""
        message = ArmRequest(arm, reset, (sender or self.sender) if arm else "", epoch)
        self.link.publish("arm_request", message, self._origin("people"))

    def estop(self, stop: bool = True) -> None:
        """Press the e-stop; or hold a dead man's switch for a moment."""
        self.link.publish("estop", EStop(stop), self._origin("people"))

    def send(
        self, values: Sequence[float], sender: str = "", behind: int = 0, age_s: float = 0.0, counts: bool = True
    ) -> None:
        """Send one command.

        Args:
          values: One of each axis.
          sender: Another sender than the armed one.
          behind: Its number is that much behind the last one; 0: the next number.
          age_s: Its stamp is so old.
          counts: It is valid: an armed driver should take it.
        """
        origin = self._origin(sender or self.sender, behind)
        stamp_ns = round((self.link.now_s() - age_s) * 1e9)
        self.sent += counts
        for topic, message in messages_of(self.domain, tuple(values), max(1, stamp_ns)):
            self.link.publish(topic, message, origin)

    def drive(self, values: Sequence[float], seconds: float) -> None:
        """Command set-points for some time, ten times a second."""
        for _ in range(max(1, round(seconds / PERIOD_S))):
            self.send(values)
            self.wait(PERIOD_S)

    @property
    def rest(self) -> tuple[float, ...]:
        """The command that stops all axes."""
        return at_rest(self.domain.axes)

    def tests(self) -> Iterator[tuple[int, float]]:
        """Index and test speed of each axis that sensors have shown, without those that keep their set-points."""
        for index, (axis, limit) in enumerate(zip(self.domain.axes, self.spec.limits, strict=True)):
            if limit.kept is None and (index in self._shown or self.measured(axis.name) is not None):
                self._shown.add(index)
                yield index, farther(limit) * self.fraction

    def tested_axes(self) -> list[tuple[int, float]]:
        """All of `tests`.

        Raises:
          NotPossible: There is none.
        """
        if found := list(self.tests()):
            return found
        names = ", ".join(axis.name for axis in self.domain.axes if axis.kept is None)
        raise NotPossible(f"no sensor shows the speed of an axis, expected a field or a joint named as one: {names}")

    def moving(self) -> tuple[float, ...]:
        """A command that moves the first axis that sensors show.

        Raises:
          NotPossible: There is none.
        """
        index, speed = self.tested_axes()[0]
        return tuple(speed if each == index else value for each, value in enumerate(self.rest))

    def measured(self, axis: str, window_s: float = 0.2) -> float | None:
        """Mean speed of an axis over the last moments, or else its newest of BLIND_S; None if no sensor shows it."""
        now_s = self.link.now_s()
        recent = itertools.takewhile(lambda each: each.at_s >= now_s - BLIND_S, reversed(self.log))
        speeds = [(each.at_s, value) for each in recent if (value := speed_in(each, axis)) is not None]
        values = [value for at_s, value in speeds if at_s >= now_s - window_s] or [value for _, value in speeds[:1]]
        return sum(values) / len(values) if values else None

    def is_moving(self) -> bool:
        """Whether an axis moves at more than a third of its test speed.

        Raises:
          NotPossible: A sensor that has shown an axis is silent: the robot may stand or roll on.
        """
        speeds = [(self.domain.axes[i].name, speed) for i, speed in self.tests()]
        found = {name: self.measured(name) for name, _ in speeds}
        if silent := [name for name, speed in found.items() if speed is None]:
            raise NotPossible(f"no sensor shows the speed of {', '.join(silent)} any more")
        return any(abs(found[name] or 0.0) > abs(speed) / 3 for name, speed in speeds)

    def begin(self) -> None:
        """Bring the driver to rest, disarmed and with no e-stop latched.

        Raises:
          NotPossible: The robot does not come to rest.
        """
        if self.state().mode == "estopped":
            self.request(reset=True)
        self.request(arm=False)
        self.wait(SETTLE_S)
        self.await_rest()

    def await_rest(self) -> None:
        """Listen until the robot has come to rest: some coast for seconds.

        Raises:
          NotPossible: It does not.
        """
        until_s = self.link.now_s() + PATIENCE_S
        while self.is_moving():
            if self.link.now_s() > until_s:
                raise NotPossible("the robot does not come to rest")
            self.wait(SETTLE_S)

    def arm(self) -> None:
        """Arm the driver for `sender`, which keeps it at rest.

        Raises:
          NotPossible: It is not armed then.
        """
        self.request()
        self.drive(self.rest, SETTLE_S)
        state = self.state()
        if state.mode != "armed" or state.armed_sender != self.sender:
            raise NotPossible(f"it cannot be armed: it is {state.mode}, {state.reason} {state.detail}".rstrip())

    def arm_in_motion(self) -> tuple[float, ...]:
        """Arm the driver and move; the command that does.

        Raises:
          NotPossible: The robot does not move.
        """
        self.arm()
        command = self.moving()
        self.drive(command, 1.0)
        if not self.is_moving():
            raise NotPossible("the robot does not move")
        return command

    def _origin(self, sender: str, behind: int = 0) -> Origin:
        self._numbers[sender] += not behind
        known = sender if len(sender) == len(self.sender) else self.other
        return Origin(self._numbers[sender] - behind, round(self.link.now_s() * 1e9), known)


def farther(limit: Limit) -> float:
    """The limit of an axis in the direction in which it goes faster: a vehicle may hardly go back, or not at all."""
    return limit.upper if limit.upper >= -limit.lower else limit.lower
