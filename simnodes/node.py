"""A simulated robot on the bus: steps its world in real time behind the driver's guard and publishes its sensors."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tailor.runtime.bus.inbox import by_reason
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import Clock, wall_ns
from tailor.runtime.loop import Loop, Period
from tailor.runtime.processes.notify import SILENT, Notifier
from tailor.schemas.messages.message import stamped
from tailor.simnodes.body import Reading
from tailor.simnodes.driver import TOPICS, Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Reason
from tailor.simnodes.services import NAMES, Services
from tailor.simnodes.world import World

PERIOD_NS = 10_000_000  # world time of one period; the guard's stop is late by at most as much
# Periods to catch up after a stall, of which the world loses the rest, or that were requested: an e-stop waits for
# those that have begun, and fifty at once would publish more than the bus takes.
MAX_AT_ONCE = 10


class Node:
    """A robot's driver with a simulated world behind it.

    Attributes:
      driver: The driver; its guard filters the commands.
    """

    def __init__(
        self,
        world: World,
        spec: DriverSpec,
        session: Session,
        clock: Clock,
        epoch: int,
        speed: float = 1.0,
        leave: str = "",
    ) -> None:
        """Subscribe and declare publishers and services.

        Args:
          world: World, already reset.
          spec: Command topic, axes and limits of the driver.
          session: Bus session.
          clock: Monotonic clock.
          epoch: Identifies this start; different at every start, and not 0.
          speed: World seconds per real second; the guard's timeout stays in real time.
          leave: Sender id of the executive that may arm the driver by itself, once; empty: only people may.
        """
        robot = world.body.robot
        self.driver = Driver(spec, epoch, leave)
        self._world, self._clock = world, clock
        self._loop = Loop(round(PERIOD_NS / speed), clock)
        self._inbox = session.inbox((*TOPICS, *spec.command_topics), robot)
        self._session = session
        self._publishers = {"driver": session.publisher("driver", robot)}
        servers = {name: session.service_server(f"{robot}/sim/{name}") for name in NAMES}
        self._services = Services(world, servers, on_reset=lambda: self.driver.guard.disarm(Reason.WORLD_RESET))
        self._frozen_ns = 0  # real time during which the world was paused; the guard's clock leaves it out

    def run(self, stopped: Callable[[], bool], notifier: Notifier = SILENT) -> None:
        """Run period after period until `stopped()` is true; the robot is disarmed at the end.

        Args:
          stopped: Called before every period.
          notifier: Receives that the node is ready, and a report of every period.
        """
        notifier.ready()
        while not stopped():
            self.run_period()
            notifier.alive()
        notifier.stopping()
        self.driver.guard.disarm(Reason.SHUTDOWN)
        self._publish_state(self._clock.now_ns())

    def run_period(self) -> None:
        """Wait for the next period and run it; `run` does so until it is stopped."""
        self._run_period(self._loop.wait_for_next_period())

    def _run_period(self, period: Period) -> None:
        self._services.answer()
        guard_ns = period.now_ns - self._frozen_ns
        self._receive(period.now_ns)
        elapsed, steps = 1 + period.skipped, min(1 + period.skipped, MAX_AT_ONCE)
        if self._services.paused:
            steps = self._services.take_steps(MAX_AT_ONCE)
            self._frozen_ns += (elapsed - steps) * self._loop.period_ns
        for _ in range(steps):
            self._world.body.command(self.driver.set_points(guard_ns, self._world.kept))
            self._publish(self._world.advance(PERIOD_NS))
            if self._services.paused:  # in lock-step the guard's time is the world's
                guard_ns += self._loop.period_ns
        self._publish_state(period.now_ns)

    def _receive(self, now_ns: int) -> None:
        accepted = self.driver.guard.accepted
        self.driver.take(self._inbox.drain(now_ns), by_reason(self._inbox.rejected), now_ns, self._frozen_ns)
        if self.driver.guard.accepted > accepted:
            self._world.begin()

    def _publish(self, readings: Sequence[Reading]) -> None:
        # Other ROS nodes expect wall time in a header: the world's time counts from this origin.
        origin_ns = wall_ns() - self._world.time_ns
        for reading in readings:
            self._publisher(reading.topic).publish(stamped(reading.message, origin_ns + reading.time_ns))

    def _publisher(self, topic: str) -> Publisher:
        if topic not in self._publishers:  # the sensors of a body are known from their first readings
            self._publishers[topic] = self._session.publisher(topic, self._world.body.robot)
        return self._publishers[topic]

    def _publish_state(self, now_ns: int) -> None:
        state = self.driver.state(now_ns, wall_ns())
        if state is not None:
            self._publishers["driver"].publish(state)
