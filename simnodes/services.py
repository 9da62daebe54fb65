"""Services of a simulator on the bus: reset, place, pause, step; requests in JSON, replies of one line."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from tailor.runtime.bus.service import ServiceRequest, ServiceServer
from tailor.simnodes.world import Event, World

NAMES = ("reset", "place", "pause", "step")
MAX_STEPS = 6000  # that may be due: a minute of 10 ms
MAX_EVENTS = 100  # of one start
MAX_VALUE = 1000.0  # m, rad, m/s or rad/s: the physics diverge far beyond


class Services:
    """Answers the service requests of one node, once a period.

    reset: {"seed": 3, "start": {"x": 1.0}, "events": [{"at_s": 2.0, "ball_x": 1.0}]}, all optional, events only with
    a start · place: {"ball_x": 1.0} · pause: true or false · step: number of periods, only while paused.

    Attributes:
      paused: The world stands still, except for requested steps.
      steps_due: Periods that are to be run, and are not yet; none unless paused.
    """

    def __init__(self, world: World, servers: Mapping[str, ServiceServer], on_reset: Callable[[], None]) -> None:
        self.paused = False
        self.steps_due = 0
        self._world = world
        self._servers = servers
        self._on_reset = on_reset
        self._handlers = {"reset": self._reset, "place": self._place, "pause": self._pause, "step": self._step}

    def answer(self) -> None:
        """Execute the requests since the last period, at most one of each service."""
        for name, server in self._servers.items():
            request = server.poll()
            if request is not None:
                self._reply(name, request)

    def take_steps(self, most: int) -> int:
        """The number of periods to run now, of those that are due."""
        steps = min(self.steps_due, most)
        self.steps_due -= steps
        return steps

    def _reply(self, name: str, request: ServiceRequest) -> None:
        try:
            reply = self._handlers[name](json.loads(request.text or "{}"))
        except (ValueError, RecursionError) as error:
            request.refuse(f"{name}: {error}")
        else:
            request.accept(reply)

    def _reset(self, argument: Any) -> str:
        if not isinstance(argument, dict) or argument.keys() - {"seed", "start", "events"}:
            raise ValueError('expected {"seed": whole number, "start": {name: number}, "events": [...]}, all optional')
        seed = argument.get("seed")
        if seed is not None and (type(seed) is not int or seed < 0):
            raise ValueError(f"seed is {seed!r}, expected a whole number of at least 0")
        if "events" in argument and "start" not in argument:
            raise ValueError("events without a start, expected a start of their own")
        events = self._events(argument.get("events", []))
        self.steps_due = 0  # they were requested of another world
        self._world.reset(seed, self._numbers(argument["start"]) if "start" in argument else None, events)
        self._on_reset()
        return "reset"

    def _events(self, argument: Any) -> list[Event]:
        if not isinstance(argument, list) or len(argument) > MAX_EVENTS:
            raise ValueError(f"expected a list of at most {MAX_EVENTS} events")
        return [self._event(each) for each in argument]

    def _event(self, argument: Any) -> Event:
        values = self._numbers(argument, "at_s")
        at_s = values.pop("at_s", -1.0)
        if at_s < 0.0:
            raise ValueError('expected events like {"at_s": 2.0, "ball_x": 1.0}, in seconds since the first command')
        return Event(at_s, values)

    def _place(self, argument: Any) -> str:
        self._world.body.place(self._numbers(argument))
        return "placed"

    def _pause(self, argument: Any) -> str:
        if type(argument) is not bool:
            raise ValueError("expected true or false")
        self.paused, self.steps_due = argument, 0
        return "paused" if argument else "running"

    def _step(self, argument: Any) -> str:
        if not self.paused:
            raise ValueError("pause first")
        if type(argument) is not int or not 1 <= argument <= MAX_STEPS:
            raise ValueError(f"expected a number of periods, 1 to {MAX_STEPS}")
        if self.steps_due + argument > MAX_STEPS:
            raise ValueError(f"{self.steps_due} periods are still due, expected at most {MAX_STEPS} with the new ones")
        self.steps_due += argument
        return f"{argument} periods"

    def _numbers(self, argument: Any, *others: str) -> dict[str, float]:
        """Values of the body by name, and of these other names."""
        legal = isinstance(argument, dict) and all(
            type(value) in (int, float) and abs(value) <= MAX_VALUE for value in argument.values()
        )
        if not legal:
            raise ValueError(f"expected an object of numbers up to {MAX_VALUE:g}, e.g. " + '{"x": 1.0}')
        names = (*others, *self._world.body.names)
        unknown = sorted(argument.keys() - set(names))
        if unknown:
            raise ValueError(f"unknown name {', '.join(unknown)[:100]}, expected some of: {', '.join(names)}")
        values = {name: float(value) for name, value in argument.items()}
        refusal = getattr(self._world.body, "refusal", None)
        if refusal is not None and (refused := refusal(values)):
            raise ValueError(refused)
        return values
