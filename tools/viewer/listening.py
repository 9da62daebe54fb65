"""A running system into rows: a plain subscriber that looks twenty times a second and publishes nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from runtime.clock import Clock
from runtime.loop import Loop
from schemas.messages import Provenance, Sample
from schemas.topics import TOPICS
from tools.viewer.about import about
from tools.viewer.feed import Feed
from tools.viewer.story import Story

LOOK_NS = 50_000_000  # twice the executive's rate: no state is overwritten before it was seen
EXECUTIVE = tuple(name for name, topic in TOPICS.items() if topic.key.startswith("exec/"))


class Inbox(Protocol):
    """What arrives."""

    def drain(self) -> tuple[Sample, ...]:
        """New samples, oldest first."""
        ...


class Bus(Protocol):
    """What makes inboxes: a `runtime.session.Session`."""

    def inbox(self, names: tuple[str, ...], robot: str) -> Inbox:
        """The new samples of these topics."""
        ...


def robot_topics() -> tuple[str, ...]:
    """Everything that a robot and its simulator say, and what they are told by the executive."""
    return tuple(name for name, topic in TOPICS.items() if "{robot}" in topic.key and topic.source != "people")


class Listener:
    """Follows the executive, and the robot that its provenance names as soon as it is known."""

    def __init__(self, bus: Bus, story: Story, feed: Feed, robot: str = "") -> None:
        self._bus = bus
        self._story = story
        self._feed = feed
        self._robot = ""
        self._began_ns: int | None = None
        self._inboxes = [bus.inbox((*EXECUTIVE, "estop"), robot)]
        self._follow(robot)

    def look(self) -> None:
        """Take what has arrived and hand it on."""
        samples = sorted((s for inbox in self._inboxes for s in inbox.drain()), key=lambda s: s.arrival_ns)
        rows = []
        for sample in samples:
            if self._began_ns is None:
                self._began_ns = sample.arrival_ns
            if isinstance(sample.message, Provenance):
                self._follow(about(sample.message.json).get("robot", ""))
            at_s = max(0.0, (sample.arrival_ns - self._began_ns) / 1e9)
            rows += self._story.tell(at_s, sample.key, sample.message)
        self._feed.publish(rows)

    def run(self, clock: Clock, stopped: Callable[[], bool]) -> None:
        """Look until told to stop."""
        loop = Loop(LOOK_NS, clock)
        while not stopped():
            loop.next_turn()
            self.look()

    def _follow(self, robot: str) -> None:
        if robot and robot != self._robot:
            self._robot = robot
            self._inboxes[1:] = [self._bus.inbox(robot_topics(), robot)]
