"""The body contract: physics and sensors of a simulated robot, behind its driver.

The sim node steps a body in real time and publishes its readings; lock-step runs step it as fast as possible.
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
    """A measurement, and the time at which the driver publishes it."""

    topic: str  # name in tailor.schemas.topics
    message: Message
    time_ns: int  # body time


class Body(Protocol):
    """A robot in its world. Seed, start and commands determine all states, bit for bit, in every process.

    One that cannot take every finite start value has a method `refusal(values) -> str`: what is wrong with values from
    outside, empty if nothing is. One with axes that are kept when the robot stops (`kept` in driver.toml) has a method
    `kept() -> tuple[float, ...]`: a set-point for each axis, at which these stay where they are.

    Attributes:
      robot: Name of the robot, as in topic keys.
      names: Names of the start values, which `place` takes too.
    """

    robot: str
    names: tuple[str, ...]

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """Set the start state and body time 0.

        Args:
          rng: Source of all noise until the next reset.
          start: Start values by name (SI units); every body has defaults for names left out.
        """
        ...

    def command(self, values: tuple[float, ...]) -> None:
        """Take a set-point that the guard has passed, in the order and units of the driver's axes."""
        ...

    def advance(self, duration_ns: int) -> list[Reading]:
        """Step the physics.

        Args:
          duration_ns: A multiple of STEP_NS.

        Returns:
          The readings that fall due, in order of time.
        """
        ...

    def place(self, values: Mapping[str, float]) -> None:
        """Simulator service: move or push something while the clock runs; names as in `reset`, others stay."""
        ...

    def ground_truth(self) -> Message:
        """The true state of the world now."""
        ...
