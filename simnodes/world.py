"""A simulated world on its way through an episode: a body, its seeds, and the events that befall it.

Knows no bus and no wall clock: the node hands it time in steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.simnodes.body import STEP_NS, Body, Reading

NOISE_STREAM = 1  # of the seed; the scenario is drawn from stream 0


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens to the world by itself, e.g. the ball is kicked."""

    at_s: float  # since the first command that was obeyed after a reset
    place: Mapping[str, float]


class World:
    """One body, reset and stepped; `time_ns` is its time since the last reset."""

    def __init__(self, body: Body, start: Mapping[str, float], seed: int, events: Sequence[Event] = ()) -> None:
        self.body = body
        self.time_ns = 0
        self._start, self._seed = dict(start), seed
        self.events = tuple(sorted(events, key=lambda event: event.at_s))
        self._pending: list[Event] = []
        self._begun_ns: int | None = None
        self.reset()

    def reset(self, seed: int | None = None, start: Mapping[str, float] | None = None) -> None:
        """Back to the start, with the same noise again unless another seed is given."""
        noise = np.random.default_rng([self._seed if seed is None else seed, NOISE_STREAM])
        self.body.reset(noise, self._start if start is None else start)
        self.time_ns = 0
        self._pending = list(self.events)
        self._begun_ns = None

    def begin(self) -> None:
        """A command is being obeyed: the events' clock starts, if it has not."""
        if self._begun_ns is None:
            self._begun_ns = self.time_ns

    def advance(self, duration_ns: int) -> list[Reading]:
        """Step the body by a multiple of STEP_NS; events that are due come first. Readings in order."""
        if duration_ns % STEP_NS:
            raise ValueError(f"duration_ns is {duration_ns}, expected a multiple of {STEP_NS}")
        while self._begun_ns is not None and self._pending and self._due_ns(self._begun_ns) <= self.time_ns:
            self.body.place(self._pending.pop(0).place)
        self.time_ns += duration_ns
        return self.body.advance(duration_ns)

    def _due_ns(self, begun_ns: int) -> int:
        return begun_ns + round(self._pending[0].at_s * 1e9)
