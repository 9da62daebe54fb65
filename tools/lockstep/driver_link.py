"""Replaces the bus in lock-step runs: carries commands to a driver and readings back, without delay or loss."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.interfaces.domain import Domain
from tailor.schemas.messages import ArmRequest, Message, Sample
from tailor.schemas.topics import TOPICS, key_of
from tailor.simnodes.body import Reading
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.world import World

DRIVER = "d1" * 16  # of the driver's messages
EPOCH = 1

Transport = Callable[[Message], Message]  # returns a reading as the core receives it


class DriverLink:
    """The driver and guard of a robot before its simulated world."""

    def __init__(self, domain: Domain, world: World, sender: str, transport: Transport | None = None) -> None:
        """Start disarmed.

        Args:
          domain: Provides the robot and its sensors.
          world: World, already reset.
          sender: Sender id of the executive, which may arm the driver once.
          transport: Passes readings on as the bus does; None: the core receives the very values.
        """
        self._robot, self._sensors = domain.robot, domain.sensors
        self._world, self._sender, self._transport = world, sender, transport
        self._spec = shipped_driver_spec(domain.robot)
        self._driver = Driver(self._spec, EPOCH, leave=sender)
        self._sequences: Counter[str] = Counter()  # by topic, as publishers count

    def send(self, outputs: Sequence[Output], now_ns: int, tick: int) -> None:
        """Pass the tick's commands and requests to the driver."""
        received = (*self._spec.command_topics, "self_arm")
        samples = [
            Sample(key_of(o.topic, self._robot), o.message, now_ns, tick, self._sender)
            for o in outputs
            if o.topic in received
        ]
        self._driver.take(samples, {}, now_ns)
        if any(not isinstance(sample.message, ArmRequest) for sample in samples):
            self._world.begin()

    def advance(self, now_ns: int) -> tuple[tuple[Sample, ...], tuple[Message, ...]]:
        """Advance the world by one period.

        Returns:
          The newest reading of each sensor and the driver's state, oldest first; the newest messages of ground truth.
        """
        self._world.body.command(self._driver.set_points(now_ns, self._world.kept))
        newest: dict[str, Reading] = {}
        for reading in self._world.advance(PERIOD_NS):
            newest[reading.topic] = reading
            self._sequences[reading.topic] += 1
        truth = tuple(newest.pop(topic).message for topic in list(newest) if TOPICS[topic].source == "simulator")
        samples = [self._sample(r.topic, r.message, r.time_ns) for r in newest.values() if r.topic in self._sensors]
        after_ns = now_ns + PERIOD_NS
        driver = self._driver.state(after_ns, after_ns)
        if driver is not None:
            self._sequences["driver"] += 1
            samples.append(self._sample("driver", driver, after_ns))
        return tuple(sorted(samples, key=lambda sample: sample.arrival_ns)), truth

    def _sample(self, topic: str, message: Message, arrival_ns: int) -> Sample:
        received = message if self._transport is None else self._transport(message)
        return Sample(key_of(topic, self._robot), received, arrival_ns, self._sequences[topic], DRIVER)
