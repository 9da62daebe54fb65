"""What people may ask of a simulator over the bus: reset, place, pause, step; in JSON, answered in one line."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from tailor.runtime.bus.service import ServiceRequest, ServiceServer
from tailor.simnodes.world import World

NAMES = ("reset", "place", "pause", "step")
MAX_STEPS = 6000  # in one request: a minute of 10 ms
MAX_VALUE = 1000.0  # m, rad, m/s or rad/s: physics breaks down far beyond


class Services:
    """Answers the questions of one node, once a turn.

    reset: {"seed": 3, "start": {"x": 1.0}}, both optional · place: {"ball_x": 1.0} · pause: true or false ·
    step: number of periods, only while paused.
    """

    def __init__(self, world: World, questions: Mapping[str, ServiceServer], on_reset: Callable[[], None]) -> None:
        self.paused = False
        self.steps_due = 0  # periods to run while paused
        self._world = world
        self._questions = questions
        self._on_reset = on_reset
        self._answers = {"reset": self._reset, "place": self._place, "pause": self._pause, "step": self._step}

    def answer(self) -> None:
        """Do what was asked since the last turn, at most one question of a kind."""
        for name, questions in self._questions.items():
            question = questions.poll()
            if question is not None:
                self._reply(name, question)

    def _reply(self, name: str, question: ServiceRequest) -> None:
        try:
            said = self._answers[name](json.loads(question.text or "{}"))
        except (ValueError, RecursionError) as error:
            question.refuse(f"{name}: {error}")
        else:
            question.accept(said)

    def _reset(self, asked: Any) -> str:
        if not isinstance(asked, dict) or asked.keys() - {"seed", "start"}:
            raise ValueError('expected {"seed": whole number, "start": {name: number}}, both optional')
        seed = asked.get("seed")
        if seed is not None and (type(seed) is not int or seed < 0):
            raise ValueError(f"seed is {seed!r}, expected a whole number of at least 0")
        self._world.reset(seed, self._numbers(asked["start"]) if "start" in asked else None)
        self._on_reset()
        return "reset"

    def _place(self, asked: Any) -> str:
        self._world.body.place(self._numbers(asked))
        return "placed"

    def _pause(self, asked: Any) -> str:
        if type(asked) is not bool:
            raise ValueError("expected true or false")
        self.paused = asked
        return "paused" if asked else "running"

    def _step(self, asked: Any) -> str:
        if not self.paused:
            raise ValueError("pause first")
        if type(asked) is not int or not 1 <= asked <= MAX_STEPS:
            raise ValueError(f"expected a number of periods, 1 to {MAX_STEPS}")
        self.steps_due += asked
        return f"{asked} periods"

    def _numbers(self, asked: Any) -> dict[str, float]:
        legal = isinstance(asked, dict) and all(
            type(value) in (int, float) and abs(value) <= MAX_VALUE for value in asked.values()
        )
        if not legal:
            raise ValueError(f"expected an object of numbers up to {MAX_VALUE:g}, e.g. " + '{"x": 1.0}')
        names = self._world.body.names
        unknown = sorted(asked.keys() - set(names))
        if unknown:
            raise ValueError(f"there is no {', '.join(unknown)[:100]}, expected some of: {', '.join(names)}")
        return {name: float(value) for name, value in asked.items()}
