"""A link to a driver on the bus, a simulator or hardware, in real time."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence

from tailor.runtime.bus.attachment import Origin, unpack
from tailor.runtime.bus.inbox import Source
from tailor.runtime.bus.session import Session
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.schemas.ros2.graph import Kind
from tailor.schemas.ros2.plain import frame_in
from tailor.schemas.ros2.profiles import ros_topic
from tailor.schemas.ros2.type_mismatches import mismatches
from tailor.schemas.topics import TOPICS
from tailor.tools.conformance.link import Heard

POLL_S = 0.002
MATCH_S = 5.0  # for the driver to appear
PEOPLE = ("arm_request", "estop")


class NoDriverError(Exception):
    """Nobody takes commands on the bus."""


class LiveLink:
    """Publishes as an executive and as people; hears what the driver publishes."""

    def __init__(
        self, executive: Session, people: Session, robot: str, commands: Sequence[str], sensors: Iterable[str]
    ) -> None:
        """Subscribe, and wait for the driver.

        Raises:
          NoDriverError: There is none within MATCH_S, or under rmw_zenoh one of other types.
        """
        graph = executive.graph_view(executive.keys.domain) if executive.keys.announces else None
        names = ("driver", "estop", *sensors)
        self._sources = [(name, source) for name in names for source in executive.raw_sources(name, robot)]
        self._publishers = {name: executive.publisher(name, robot) for name in commands}
        self._publishers |= {name: people.publisher(name, robot) for name in PEOPLE}
        self._stalled_s = 0.0
        until_s = time.monotonic() + MATCH_S
        while not all(publisher.matched() for publisher in self._publishers.values()):
            if time.monotonic() > until_s:
                ours = [(Kind.PUBLISHER, ros_topic(TOPICS[name], robot)) for name in commands]
                others = "; ".join(map(str, mismatches(ours, graph.announced()))) if graph else ""
                nobody = (
                    f"no driver of {robot} within {MATCH_S:g} s, expected one on the bus, e.g. `tailor sim {robot}`"
                )
                raise NoDriverError(others or nobody)
            time.sleep(POLL_S)

    def now_s(self) -> float:
        """Monotonic time."""
        return time.monotonic()

    def wall_s(self, at_s: float) -> float:
        """Wall time, seconds since 1970, at a monotonic time, by today's distance of both clocks."""
        return at_s + time.time() - time.monotonic()

    def wait(self, seconds: float) -> list[Heard]:
        """Listen for that long."""
        until_s, heard = time.monotonic() + seconds, list[Heard]()
        while True:
            now_s = time.monotonic()
            for topic, source in self._sources:
                heard += self._received(topic, source, now_s)
            if now_s >= until_s:
                return heard
            pause_s = min(POLL_S, until_s - now_s)
            time.sleep(pause_s)
            self._stalled_s = max(self._stalled_s, time.monotonic() - now_s - pause_s)

    def stalled_s(self) -> float:
        """Longest delay of this process since the last call."""
        stalled_s, self._stalled_s = self._stalled_s, 0.0
        return stalled_s

    def publish(self, topic: str, message: Message, origin: Origin) -> None:
        """Publish with any origin."""
        self._publishers[topic].put_raw(encode(message), origin)

    def _received(self, topic: str, source: Source, now_s: float) -> list[Heard]:
        heard = []
        while (raw := source.receive()) is not None:
            if isinstance(raw, Rejected):
                continue
            message, origin = decode(TOPICS[topic], raw.payload), unpack(raw.attachment)
            if isinstance(message, Message) and isinstance(origin, Origin):
                stamp_s = getattr(message, "stamp_ns", 0) * 1e-9 or now_s
                frame = frame_in(raw.payload)
                heard.append(Heard(now_s, stamp_s, topic, message, frame, origin.sender, origin.sequence))
        return heard
