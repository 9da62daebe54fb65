"""Tasks that people set, one after another, without ending the executive.

A soccer task starts anew in another world. The arm remembers what is drawn, so it could write a word only once: its
word is a ring, of which each task is a part. Neither robot rests for longer than people need.
"""

from __future__ import annotations

import json
import random
from typing import Protocol

from tailor.executive import domains
from tailor.tools.soak.systems.system import System

BELIEF_NS = 1_500_000_000  # after the world was reset: the belief converges again
WAYPOINTS = 20  # of a task of the arm: about 10 s
LETTERS = 12
CAPITALS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
REPEATABLE = ("approach-dribble", "aligned", "moved-ball", "kicked-ball", "approach")


class Tasks(Protocol):
    """Tasks of one start of a system."""

    scenario: str

    def begin(self, now_ns: int) -> int:
        """Another executive runs; returns when it needs a goal of people's, 0: it has its own."""
        ...

    def prepare(self, now_ns: int) -> int:
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
        self._begun = False

    def begin(self, now_ns: int) -> int:
        """The first executive has the scenario's goal, a restarted one has none."""
        begun, self._begun = self._begun, True
        return now_ns if begun else 0

    def prepare(self, now_ns: int) -> int:
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
    """A part of the word for each task; see `Tasks`."""

    def __init__(self, system: System, draw: random.Random) -> None:
        """Draw a word."""
        self.scenario = "ring-" + "".join(draw.choices(CAPITALS, k=LETTERS))
        self._waypoints = tuple(domains.seeded_scenario("arm", self.scenario, 0)[0].places)
        self._reached = 0

    def begin(self, now_ns: int) -> int:
        """A new executive begins the word anew."""
        self._reached = 0
        return now_ns

    def prepare(self, now_ns: int) -> int:
        """The next part can follow at once."""
        return now_ns

    def goal(self) -> str:
        """The next part of the ring."""
        self._reached += WAYPOINTS
        return f"(at {self._waypoints[self._reached % len(self._waypoints)]})"


def tasks_of(system: System, draw: random.Random) -> Tasks:
    """Tasks of a robot."""
    return ArmTasks(system, draw) if system.robot.domain == "arm" else SoccerTasks(system, draw)
