"""What every simulated body offers its driver: the physics and sensors behind the driver contract.

The sim node steps a body in real time and puts its readings on the bus; lock-step runs step it as fast as they can.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tailor.schemas.messages import Message

STEP_NS = 10_000_000  # every duration handed to a body is a multiple of this


@dataclass(frozen=True, slots=True)
class Reading:
    """What a sensor says, and when it comes out of the driver."""

    topic: str  # name in tailor.schemas.topics
    message: Message
    time_ns: int  # body time


class Body(Protocol):
    """A robot in its world. The same seed, start and commands give the same states, bit for bit, in every process."""

    robot: str
    names: tuple[str, ...]  # of the values of a start state, which `place` takes, too

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """Put the world into a start state and its clock to 0; all noise until the next reset is drawn from `rng`."""
        ...

    def command(self, values: tuple[float, ...]) -> None:
        """Take a set-point that the guard has accepted, in the order of the driver's axes."""
        ...

    def advance(self, duration_ns: int) -> list[Reading]:
        """Step the physics, `duration_ns` a multiple of STEP_NS; the readings that fall due, in order."""
        ...

    def place(self, values: Mapping[str, float]) -> None:
        """Simulator service: move or push a thing while the clock runs; names as in `reset`."""
        ...

    def ground_truth(self) -> Message:
        """The state of the world now, as the simulator tells it."""
        ...
