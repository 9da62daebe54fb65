"""A simulated porter on a line, who carries cups: long plans for the executive, without physics or learned models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.interfaces.action import Action, Control, Parameter
from tailor.executive.interfaces.domain import Axis, LabelQuery, Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array, Belief, Fact, Interval
from tailor.schemas.messages import Message, Odometry, Sample, VelocityCommand

PLACES_M = {"dock": 0.0, "table1": 0.1, "table2": 0.2}
NEAR_M = 0.02


@dataclass(frozen=True, slots=True)
class PorterBelief:
    """Position on the line; `seen` once an odometry sample has arrived."""

    x_m: float = 0.0
    seen: bool = False


def _navigate(state: Any, now_ns: int, belief: Belief, arguments: Array) -> Control:
    """Drive to arguments[1] at arguments[2] m/s; done there."""
    error_m = float(arguments[1]) - belief.x_m
    if abs(error_m) < NEAR_M:
        return Control(state, (0.0,), "done")
    return Control(state, (float(np.sign(error_m)) * min(float(arguments[2]), 10 * abs(error_m)),))


def _handle(state: Any, now_ns: int, belief: Belief, arguments: Array) -> Control:
    """Grip or put: done in the second tick."""
    return Control(True, (0.0,), "done" if state else "running")


class _DriveDuration:
    """Seconds for a distance at a speed; arguments as of navigate."""

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """See `DurationModel`."""
        return np.abs(arguments[:, 1] - arguments[:, 0]) / arguments[:, 2], np.zeros(len(arguments))


class _HandleDuration:
    """A fifth of a second."""

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """See `DurationModel`."""
        return np.full(len(arguments), 0.2), np.zeros(len(arguments))


def _place(name: str, argument: int, tolerance: float | None = None) -> Parameter:
    return Parameter(name, argument, "x", "m", -1.0, 1.0, tolerance=tolerance)


_SPEED = Parameter("v", 1, "v", "m/s", 0.5, 1.0)
ACTIONS = {
    "navigate": Action("navigate", (_place("x", 0), _place("xg", 1, 0.05), _SPEED), _navigate, "navigate/duration"),
    "grip": Action("grip", (_place("x", 1, 0.05),), _handle, "handle/duration"),
    "put": Action("put", (_place("x", 1, 0.05),), _handle, "handle/duration"),
}
MODELS = Models({"navigate/duration": _DriveDuration(), "handle/duration": _HandleDuration()}, {})


class Porter:
    """The domain; see `tailor.executive.interfaces.domain.Domain`.

    Args:
      pddl: PDDL of the kitchen: actions navigate, grip and put.
    """

    name = robot = "porter"
    command_topic = "cmd_vel"
    sensors: tuple[str, ...] = ("odom",)
    required: tuple[str, ...] = ("odom",)
    belief_names: tuple[str, ...] = ("x (m)",)
    axes: tuple[Axis, ...] = (Axis("v", "m/s", -1.0, 1.0),)

    def __init__(self, pddl: str) -> None:
        self.pddl = pddl
        self.actions: Mapping[str, Action] = ACTIONS
        self.executables: Mapping[str, str] = {name: name for name in ACTIONS}

    def initial_belief(self) -> Belief:
        """See `Domain`."""
        return PorterBelief()

    def update(self, belief: Belief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]) -> Belief:
        """See `Domain`; odometry is exact."""
        for sample in samples:
            if isinstance(sample.message, Odometry):
                belief = replace(belief, x_m=sample.message.x, seen=True)
        return belief

    def ready(self, belief: Belief) -> bool:
        """See `Domain`."""
        return bool(belief.seen)

    def belief_values(self, belief: Belief) -> tuple[float, ...]:
        """See `Domain`."""
        return (belief.x_m,)

    def anchor(self, belief: Belief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """See `Domain`; the porter observes no facts."""
        return remembered

    def value(self, query: LabelQuery) -> Interval | None:
        """See `Domain`: places are known."""
        if query.quantity != "x":
            return None
        x_m = query.scenario.places[query.label]["x"]
        return Interval(x_m, x_m)

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """See `Domain`."""
        return VelocityCommand(stamp_ns, command[0], 0.0)
