"""A simulated world during a run: a body, its seeds, and scheduled events.

It uses no bus and no wall clock: the node advances it in steps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import shown
from tailor.schemas.topics import TOPICS
from tailor.simnodes.body import STEP_NS, Body, Reading

EXPECTED = "a list of Readings (simnodes/body.py)"
NOISE_STREAM = 1  # of the seed; the scenario is drawn from stream 0


@dataclass(frozen=True, slots=True)
class Event:
    """A scheduled change of the world, e.g. the ball is kicked."""

    at_s: float  # since the first accepted command after a reset
    place: Mapping[str, float]


class World:
    """One body, reset and stepped.

    Attributes:
      body: The simulated robot and its surroundings.
      events: Scheduled events in order of time.
      time_ns: World time since the last reset.

    Raises:
      UsageError: A value of the start or of an event has a name that the body does not.
    """

    def __init__(self, body: Body, start: Mapping[str, float], seed: int, events: Sequence[Event] = ()) -> None:
        for what, values in (("start", start), *(("event", event.place) for event in events)):
            if unknown := [name for name in values if name not in body.names]:
                known = f"expected some of: {', '.join(body.names)}"
                raise UsageError(f"{what} of {body.robot}: its body has no {', '.join(unknown)} ({known})")
        self.body = body
        self.time_ns = 0
        self._start, self._seed = dict(start), seed
        self.events = _in_order(events)
        self._pending: list[Event] = []
        self._begun_ns: int | None = None
        self.reset()

    @property
    def kept(self) -> Callable[[], Sequence[float]] | None:
        """The body's method `kept`; None if it has none."""
        return getattr(self.body, "kept", None)

    def reset(
        self, seed: int | None = None, start: Mapping[str, float] | None = None, events: Sequence[Event] = ()
    ) -> None:
        """Return to the start.

        Args:
          seed: Seed of the noise; None: the world's own, which repeats the noise.
          start: Start values by name, see `Body.names`; None: the world's own, with its own events.
          events: Those of another start. The world's own have places that fit theirs alone: a ball could be put
            into the robot, which throws the one metres away or the other on its back.
        """
        noise = np.random.default_rng([self._seed if seed is None else seed, NOISE_STREAM])
        self.body.reset(noise, self._start if start is None else start)
        self.time_ns = 0
        self._pending = list(self.events if start is None else _in_order(events))
        self._begun_ns = None

    def begin(self) -> None:
        """Start the events' clock, if it is not running: a command was accepted."""
        if self._begun_ns is None:
            self._begun_ns = self.time_ns

    def advance(self, duration_ns: int) -> list[Reading]:
        """Apply the events that are due, then step the body.

        Args:
          duration_ns: A multiple of STEP_NS.

        Returns:
          Sensor readings in order of time.

        Raises:
          ValueError: `duration_ns` is no multiple of STEP_NS.
          UsageError: The body returned no readings (an empty list is one, None is not), or one that no topic has.
        """
        if duration_ns % STEP_NS:
            raise ValueError(f"duration_ns is {duration_ns}, expected a multiple of {STEP_NS}")
        while self._begun_ns is not None and self._pending and self._due_ns(self._begun_ns) <= self.time_ns:
            self.body.place(self._pending.pop(0).place)
        self.time_ns += duration_ns
        readings: Any = self.body.advance(duration_ns)
        if not isinstance(readings, list | tuple) or not all(isinstance(each, Reading) for each in readings):
            raise UsageError(
                f"advance of the body of {self.body.robot} returned {shown(readings)}, expected {EXPECTED}"
            )
        for each in readings:
            if misfit := _misfit(each):
                raise UsageError(f"advance of the body of {self.body.robot} returned {misfit}")
        return list(readings)

    def _due_ns(self, begun_ns: int) -> int:
        return begun_ns + round(self._pending[0].at_s * 1e9)


def _misfit(reading: Reading) -> str:
    """Why nobody can publish a reading; empty if it can be."""
    if reading.topic not in TOPICS:
        return f"a Reading of '{reading.topic}', expected the name of a topic"
    expected = TOPICS[reading.topic].type
    if isinstance(reading.message, expected):
        return ""
    return f"a Reading of {reading.topic} with {shown(reading.message)}, expected {expected.__name__}"


def _in_order(events: Sequence[Event]) -> tuple[Event, ...]:
    return tuple(sorted(events, key=lambda event: event.at_s))
