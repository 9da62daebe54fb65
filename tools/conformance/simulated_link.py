"""A link to a simulated driver in simulated time: node, guard and body are those of `tailor sim`, without a bus."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from typing import Any

from tailor.runtime.bus.attachment import Origin
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message, Sample
from tailor.schemas.ros2.plain import frame_in
from tailor.schemas.topics import TOPICS, key_of
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.node import Node
from tailor.simnodes.world import World
from tailor.tools.conformance.link import Heard

DRIVER = "d" * 32  # its sender id
EPOCH = 7


class SimulatedLink:
    """Clock, session and link in one; every wait runs the node's periods.

    Attributes:
      node: The node under test.
    """

    def __init__(self, world: World, spec: DriverSpec, node: type[Node] = Node) -> None:
        self._now_ns, self._robot = 1_000_000_000, world.body.robot
        self._waiting: list[Sample] = []
        self._heard: list[Heard] = []
        self.rejected: Counter[tuple[str, str]] = Counter()
        session: Any = self  # has the three methods of a session that a node uses
        self.node = node(world, spec, session, self, EPOCH)

    def now_s(self) -> float:
        """Simulated time."""
        return self._now_ns * 1e-9

    def wall_s(self, at_s: float) -> float:
        """The same: what is heard is stamped with simulated time."""
        return at_s

    def wait(self, seconds: float) -> list[Heard]:
        """Run the node for that long."""
        until_ns = self._now_ns + round(seconds * 1e9)
        while self._now_ns < until_ns:
            self.node.run_period()
        heard, self._heard = self._heard, []
        return heard

    def publish(self, topic: str, message: Message, origin: Origin) -> None:
        """Put a message into the node's inbox, decoded as on a bus."""
        key = key_of(topic, self._robot)
        received = self.received(topic, message)
        if isinstance(received, Rejected):
            self.rejected[key, received.reason] += 1
            return
        self._waiting.append(Sample(key, received, self._now_ns, origin.sequence, origin.sender))
        if topic == "estop":  # as on a bus, where a bench hears those of everybody
            now_s = self.now_s()
            self._heard.append(Heard(now_s, now_s, topic, received, "", origin.sender, origin.sequence))

    def stalled_s(self) -> float:
        """Simulated time stands still while the process does."""
        return 0.0

    def received(self, topic: str, message: Message) -> Message | Rejected:
        """The message as it is received."""
        return decode(TOPICS[topic], encode(message))

    def now_ns(self) -> int:
        """The clock of the node's loop."""
        return self._now_ns

    def sleep_until(self, deadline_ns: int) -> None:
        """Let the simulated time pass."""
        self._now_ns = max(self._now_ns, deadline_ns)

    def inbox(self, names: Sequence[str], robot: str) -> SimulatedLink:
        """The node's inbox."""
        return self

    def drain(self, now_ns: int) -> tuple[Sample, ...]:
        """What was published to the node since its last period."""
        waiting, self._waiting = self._waiting, []
        return tuple(waiting)

    def service_server(self, key: str) -> NoRequests:
        """Nobody calls the simulator's services."""
        return NoRequests()

    def publisher(self, name: str, robot: str) -> SimulatedPublisher:
        """A publisher of the node, whose messages are heard."""
        return SimulatedPublisher(self, name)

    def hear(self, topic: str, message: Message, sequence: int) -> None:
        """Take a message that the node publishes."""
        frame, now_s = frame_in(encode(message)), self.now_s()  # its stamp is real time, here time is simulated
        self._heard.append(Heard(now_s, now_s, topic, message, frame, DRIVER, sequence))


class NoRequests:
    """A service that nobody calls."""

    def poll(self) -> None:
        """No request."""


class SimulatedPublisher:
    """A publisher of the node."""

    def __init__(self, link: SimulatedLink, topic: str) -> None:
        self._link, self._topic, self._numbers = link, topic, itertools.count(1)

    def publish(self, message: Message) -> None:
        """Publish under the next number."""
        self._link.hear(self._topic, message, next(self._numbers))
