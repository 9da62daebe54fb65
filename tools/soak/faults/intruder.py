"""A session that wants more than it may, and what it needs to pass for another."""

from __future__ import annotations

import random
import time
from dataclasses import dataclass, field

from tailor.runtime.bus.attachment import Origin, unpack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import JointCommand, Message, VelocityCommand
from tailor.schemas.topics import key_of
from tailor.tools.soak.judging.robots import ROBOTS
from tailor.tools.soak.systems.strangers import FORGED_NS, stranger_id

HEAR_S = 5.0  # to the executive first, at most
HEARD = 20  # commands


@dataclass(slots=True)
class Intruder:
    """A session, what it has overheard of the executive's commands, and its random numbers."""

    session: Session
    robot: str
    draw: random.Random
    known: bool  # has credentials of an observer
    heard: list[Raw] = field(default_factory=list)

    def overhear(self) -> None:
        """Listen to the executive's commands until there are some."""
        queue, subscription = self.session.subscribe_all(key_of(self.command(), self.robot))
        ends_s = time.monotonic() + HEAR_S
        while len(self.heard) < HEARD and time.monotonic() < ends_s:
            time.sleep(0.1)
            self.heard += queue.drain()
        subscription.undeclare()

    def command(self) -> str:
        """Topic of the robot's command."""
        return next(robot.command for robot in ROBOTS if robot.name == self.robot)

    def publisher(self, topic: str) -> Publisher:
        """Publisher in the intruder's own name."""
        return self.session.publisher(topic, self.robot)

    def velocities(self, first: float, second: float) -> Message:
        """A command of the robot's type, marked as forged."""
        if self.command() == "joint_cmd":
            return JointCommand(FORGED_NS, ("pan", "lift"), (first, second))
        return VelocityCommand(FORGED_NS, first, second)

    def victim(self) -> Origin:
        """Origin of the newest command of the executive that was heard."""
        origins = [unpack(raw.attachment) for raw in self.heard]
        known = [origin for origin in origins if not isinstance(origin, Rejected) and origin.sender]
        return max(known, key=lambda origin: origin.sequence) if known else Origin(1, 0, stranger_id(2))
