"""A simulated robot on the bus: steps its world in real time behind the driver's guard, and publishes its sensors."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import Clock, wall_ns
from tailor.runtime.loop import Loop, Period
from tailor.simnodes.body import Reading
from tailor.simnodes.driver import TOPICS, Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.services import NAMES, Services
from tailor.simnodes.world import World

PERIOD_NS = 10_000_000  # of world time a turn; the guard's stop is late by at most as much
MAX_AT_ONCE = 10  # periods to catch up with after a stall; what is beyond is lost to the world


class Node:
    """One robot's driver with a world behind it, until told to stop."""

    def __init__(
        self,
        world: World,
        declared: DriverSpec,
        session: Session,
        clock: Clock,
        epoch: int,
        speed: float = 1.0,
    ) -> None:
        """Subscribe and declare.

        Args:
          world: Reset already.
          declared: What the driver takes, and within which limits.
          session: The bus.
          clock: Monotonic.
          epoch: Another one at every start, not 0.
          speed: World seconds per real second; the guard's time-out stays real.
        """
        robot = world.body.robot
        self.driver = Driver(declared, epoch)
        self._world, self._clock = world, clock
        self._loop = Loop(round(PERIOD_NS / speed), clock)
        self._inbox = session.inbox((declared.command_topic, *TOPICS), robot)
        self._session = session
        self._out = {"driver": session.publisher("driver", robot)}
        questions = {name: session.service_server(f"{robot}/sim/{name}") for name in NAMES}
        self._services = Services(world, questions, on_reset=lambda: self.driver.guard.disarm("the world was reset"))
        self._frozen_ns = 0  # real time that does not count for the guard, because the world stood still

    def run(self, stopped: Callable[[], bool]) -> None:
        """Turn after turn until `stopped` says so; leaves the robot disarmed."""
        while not stopped():
            self._turn(self._loop.wait_for_next_period())
        self.driver.guard.disarm("the driver ends")
        self._tell(self._clock.now_ns())

    def _turn(self, turn: Period) -> None:
        self._services.answer()
        guard_ns = turn.now_ns - self._frozen_ns
        self._listen(turn.now_ns, guard_ns)
        elapsed, periods = 1 + turn.skipped, min(1 + turn.skipped, MAX_AT_ONCE)
        if self._services.paused:
            periods, self._services.steps_due = self._services.steps_due, 0
            self._frozen_ns += (elapsed - periods) * self._loop.period_ns
        for _ in range(periods):
            self._world.body.command(self.driver.guard.output(guard_ns))
            self._publish(self._world.advance(PERIOD_NS))
            if self._services.paused:  # in lock-step the guard's time is the world's
                guard_ns += self._loop.period_ns
        self._tell(turn.now_ns)

    def _listen(self, now_ns: int, guard_ns: int) -> None:
        samples = (replace(s, arrival_ns=s.arrival_ns - self._frozen_ns) for s in self._inbox.drain(now_ns))
        accepted = self.driver.guard.accepted
        self.driver.take(samples, self._rejected(), guard_ns)
        if self.driver.guard.accepted > accepted:
            self._world.begin()

    def _publish(self, readings: Sequence[Reading]) -> None:
        # Wall time is what other ROS nodes expect in a header; the world's time is its distance to now.
        origin_ns = wall_ns() - self._world.time_ns
        for reading in readings:
            sensed: Any = reading.message
            message = replace(sensed, stamp_ns=origin_ns + reading.time_ns)
            self._outlet(reading.topic).publish(message)

    def _outlet(self, topic: str) -> Publisher:
        if topic not in self._out:  # which sensors a body has shows when they speak
            self._out[topic] = self._session.publisher(topic, self._world.body.robot)
        return self._out[topic]

    def _tell(self, now_ns: int) -> None:
        state = self.driver.state(now_ns, wall_ns())
        if state is not None:
            self._out["driver"].publish(state)

    def _rejected(self) -> Counter[str]:
        counts: Counter[str] = Counter()
        for (_, reason), count in self._inbox.rejected.items():
            counts[reason] += count
        return counts
