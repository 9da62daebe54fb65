"""Tasks that people set, one after another, without ending the executive.

A soccer task starts anew in another world. A letter cannot be written twice: the arm remembers what is drawn. So it
writes one long word, a few strokes at a time.
"""

from __future__ import annotations

import json
import random
from collections.abc import Sequence
from typing import Protocol

from tailor.executive import domains
from tailor.tools.soak.systems.system import System

BELIEF_NS = 1_500_000_000  # after the world was reset: the belief converges again
REST_NS = 200_000_000_000  # between two tasks of the arm, unless there is a hurry: its word is finite
STROKES = 3
LETTERS = 12
CAPITALS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
REPEATABLE = ("approach-dribble", "aligned", "moved-ball", "kicked-ball", "approach")


class Tasks(Protocol):
    """Tasks of one start of a system."""

    scenario: str

    def begin(self, now_ns: int) -> int:
        """Another executive runs; returns when it needs a goal of people's, 0: it has its own."""
        ...

    def prepare(self, now_ns: int, hurry: bool) -> int:
        """The last task has ended; returns when the next goal can be set, 0: not yet."""
        ...

    def goal(self) -> str:
        """The next goal, in PDDL; empty: that of the scenario."""
        ...


class SoccerTasks:
    """Another world for each task; see `Tasks`."""

    def __init__(self, system: System, draw: random.Random) -> None:
        """Draw a scenario."""
        self.scenario = draw.choice(REPEATABLE)
        self._system, self._draw = system, draw

    def begin(self, now_ns: int) -> int:
        """The scenario's goal is good."""
        return 0

    def prepare(self, now_ns: int, hurry: bool) -> int:
        """Another start of the same scenario; that disarms the robot."""
        robot, seed = self._system.robot, self._draw.randrange(10_000)
        scenario, start = domains.seeded_scenario(robot.domain, self.scenario, seed)
        world = {"seed": seed, "start": start, "events": scenario.settings["events"]}
        accepted, _ = self._system.call(f"{robot.name}/sim/reset", json.dumps(world))
        return now_ns + BELIEF_NS if accepted else 0

    def goal(self) -> str:
        """The scenario's."""
        return ""


class ArmTasks:
    """A few strokes for each task; see `Tasks`."""

    def __init__(self, system: System, draw: random.Random) -> None:
        """Draw a word."""
        self.scenario = "word-" + "".join(draw.choices(CAPITALS, k=LETTERS))
        self._waypoints = _waypoints(self.scenario)
        self._drawn, self._set_ns = 0, 0

    def begin(self, now_ns: int) -> int:
        """A new executive begins the whole word: only a few strokes of it, please."""
        self._drawn, self._set_ns = 0, now_ns
        return now_ns

    def prepare(self, now_ns: int, hurry: bool) -> int:
        """The next strokes, from time to time or in a hurry; none after the last."""
        if self._drawn >= len(self._waypoints) or not (hurry or now_ns > self._set_ns + REST_NS):
            return 0
        self._set_ns = now_ns
        return now_ns

    def goal(self) -> str:
        """The next strokes."""
        self._drawn = min(self._drawn + STROKES, len(self._waypoints))
        return f"(drawn {self._waypoints[self._drawn - 1]})"


def tasks_of(system: System, draw: random.Random) -> Tasks:
    """Tasks of a robot."""
    return ArmTasks(system, draw) if system.robot.domain == "arm" else SoccerTasks(system, draw)


def _waypoints(scenario: str) -> Sequence[str]:
    return tuple(domains.seeded_scenario("arm", scenario, 0)[0].places)
