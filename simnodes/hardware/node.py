"""A driver around a Hardware: bus and guard in a loop of 100 Hz, the hardware in threads of its own."""

from __future__ import annotations

from collections.abc import Callable

from tailor.runtime.bus.inbox import by_reason
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import Clock, wall_ns
from tailor.runtime.loop import Loop
from tailor.runtime.processes.notify import SILENT, Notifier
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.schemas.messages.message import stamped
from tailor.schemas.reason_text import without_numbers
from tailor.schemas.topics import TOPICS as TOPIC_TABLE
from tailor.simnodes.driver import TOPICS, Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Mode, Reason
from tailor.simnodes.hardware.calls import unfit_text
from tailor.simnodes.hardware.device import Device, Phase
from tailor.simnodes.hardware.interface import Hardware
from tailor.simnodes.hardware.watchdogs import FOREVER, RetryPolicy, SensorWatch, watched_sensors

PERIOD_NS = 10_000_000
LATER_NS = 100_000_000  # by which a read may begin later than the last measurement came, on a busy machine


class HardwareNode:
    """One robot's driver on the bus.

    Attributes:
      driver: The driver; its guard filters the commands.
      device: The hardware behind it.
    """

    def __init__(
        self,
        hardware: Hardware,
        spec: DriverSpec,
        session: Session,
        clock: Clock,
        epoch: int,
        leave: str = "",
        retry: RetryPolicy = FOREVER,
        report: Callable[[str], None] = lambda line: None,
    ) -> None:
        """Subscribe and declare publishers; the hardware is opened by `run`.

        Args:
          hardware: The robot; only `Device` calls it.
          spec: Commands, limits and sensors of the driver.
          session: Bus session.
          clock: Monotonic clock.
          epoch: Identifies this start; different at every start, and not 0.
          leave: Sender id of the executive that may arm the driver by itself, once; empty: only people may.
          retry: When the hardware is opened again after a fault.
          report: Receives lines for people: faults, and that the hardware is ready.
        """
        self.driver = Driver(spec, epoch, leave)
        self.device = Device(hardware, spec.limits, retry, clock)
        self._clock, self._loop, self._report = clock, Loop(PERIOD_NS, clock), report
        self._inbox = session.inbox((*TOPICS, *spec.command_topics), hardware.robot)
        names = [sensor.topic for sensor in spec.sensors]
        self._publishers = {name: session.publisher(name, hardware.robot) for name in ("driver", *names)}
        self._watch = SensorWatch(watched_sensors(names))
        self._opened = False  # the watch has been restarted since the hardware runs
        self._unready: str | None = None  # nothing is reported yet
        self._faulty = False  # since the fault that is reported
        self.driver.unready = Phase.OPENING.value

    def run(self, stopped: Callable[[], bool], notifier: Notifier = SILENT) -> bool:
        """Run period after period until `stopped()` is true; the robot is disarmed and the hardware closed at the end.

        Args:
          stopped: Called before every period.
          notifier: Receives that the hardware is ready for the first time, and a report of every period.

        Returns:
          Whether it ended because of `stopped`: False if the retry policy gave up.
        """
        self.device.start()
        announced = False
        try:
            while not stopped() and self.device.phase is not Phase.ENDED:
                self._run_period(self._loop.wait_for_next_period().now_ns)
                if not announced and not self.driver.unready:
                    notifier.ready()
                    announced = True
                notifier.alive()
        finally:  # also after a mistake of this program: the robot is not left in motion
            notifier.stopping()
            gave_up = self.device.phase is Phase.ENDED
            self._end(gave_up)
        return not gave_up

    def _end(self, gave_up: bool) -> None:
        if not gave_up:
            self.driver.guard.disarm(Reason.SHUTDOWN)
            self._hand(self._clock.now_ns())
        try:
            self._publish_state(self._clock.now_ns())
        finally:
            if not self.device.end():
                self._report("the hardware does not end: a call of it still waits")

    def _run_period(self, now_ns: int) -> None:
        self._sense()
        self._judge(now_ns)
        self.driver.take(self._inbox.drain(now_ns), by_reason(self._inbox.rejected), now_ns)
        self._hand(now_ns)
        self._publish_state(now_ns)

    def _sense(self) -> None:
        """Publish what was measured since the last period."""
        for at_ns, readings in self.device.readings():
            wall = wall_ns() - (self._clock.now_ns() - at_ns)
            for name, message in readings.items():
                fault = self._fault_of(name, message) or self._publish(name, message, at_ns, wall)
                if fault:
                    self.device.fail(fault)
                    return

    def _publish(self, name: str, message: Message, at_ns: int, wall: int) -> str:
        """Publish a measurement; a fault if its fields hold what no message can, e.g. None where a number belongs."""
        try:
            payload = encode(message if getattr(message, "stamp_ns", 0) else stamped(message, wall))
        except Exception as error:
            return f"read: {name} cannot be encoded: {unfit_text(message) or f'{type(error).__name__}: {error}'}"
        self._publishers[name].publish_encoded(payload)
        taken = decode(TOPIC_TABLE[name], payload)
        if isinstance(taken, Rejected):  # by every receiver: to them the sensor is silent
            self._watch.refused(name, taken.text)
        else:
            self._watch.heard(name, at_ns)
        return ""

    def _fault_of(self, name: str, message: Message) -> str:
        if name not in self._publishers or name == "driver":
            return f"read: '{name}' is no sensor of driver.toml"
        expected = TOPIC_TABLE[name].type
        return "" if type(message) is expected else f"read: {name} is no {expected.__name__}"

    def _judge(self, now_ns: int) -> None:
        """Find faults, stop the robot for them, and see whether it may be armed."""
        device, running = self.device, self.device.phase is Phase.RUNNING
        if running and not self._opened:
            self._watch.restart(now_ns)
        self._opened = running
        silent = self._watch.fault(now_ns) if running else ""
        found = device.stalled(now_ns + LATER_NS if silent else now_ns) or silent  # a call is why it is silent
        if found:
            device.fail(found)
        if device.fault:
            unready = device.fault
        elif not running:
            unready = device.phase.value
        else:
            missing = self._watch.missing()
            unready = f"no {missing} yet" if missing else ""
        self._note(unready, bool(device.fault))
        if device.notice != self.driver.notice:
            known, self.driver.notice = self.driver.notice, device.notice
            if device.notice and without_numbers(device.notice) != without_numbers(known):  # a voltage changes always
                self._report(device.notice)

    def _note(self, unready: str, is_fault: bool) -> None:
        if unready == self._unready:
            return
        self._unready = self.driver.unready = unready
        if is_fault and not self._faulty:  # one that keeps it from being opened again is none that stopped the robot
            self.driver.guard.stop(unready)
        self._faulty = is_fault
        self._report(f"not ready: {unready}" if unready else "ready")

    def _hand(self, now_ns: int) -> None:
        opening, kept, armed = self.device.opening, self.device.kept, self.driver.guard.mode is Mode.ARMED
        self.device.hand(self.driver.set_points(now_ns, kept), now_ns, armed or kept is not None, opening)

    def _publish_state(self, now_ns: int) -> None:
        state = self.driver.state(now_ns, wall_ns())
        if state is not None:
            self._publishers["driver"].publish(state)
