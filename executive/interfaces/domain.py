"""Interface that every domain implements: PDDL, executable actions, belief, meaning of the predicates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Belief, Fact, Interval
from tailor.schemas.messages import Message, Sample


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a robot's command with its limits."""

    name: str
    unit: str
    lower: float
    upper: float


@dataclass(frozen=True, slots=True)
class Scenario:
    """A task: initial abstract state and goal in PDDL, and what its labels mean.

    `places` gives known values by label, e.g. {"pos3": {"x": 0.0, "y": -1.0, "phi": 2.6}}.
    """

    name: str
    problem: str  # PDDL text
    places: Mapping[str, Mapping[str, float]]
    settings: Mapping[str, Any] = field(default_factory=dict)


class Domain(Protocol):
    """All that the executive is told about a robot and its tasks. Every function is pure."""

    name: str  # "soccer"
    robot: str  # "agilo"
    pddl: str  # domain text
    actions: Mapping[str, Action]  # by executable name
    executables: Mapping[str, str]  # PDDL action name (lower case) -> executable name
    axes: tuple[Axis, ...]
    command_topic: str  # name in tailor.schemas.topics
    sensors: tuple[str, ...]  # topic names that the belief is made from
    required: tuple[str, ...]  # those of them that must be fresh while moving
    belief_names: tuple[str, ...]  # names of belief_values, with units in parentheses

    def initial_belief(self) -> Belief:
        """The belief before the first percept."""
        ...

    def update(self, belief: Belief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]) -> Belief:
        """Filter new samples (oldest first) and predict to now; `command` is the one sent last."""
        ...

    def ready(self, belief: Belief) -> bool:
        """Whether the belief is good enough to plan and act on."""
        ...

    def belief_values(self, belief: Belief) -> tuple[float, ...]:
        """The belief's state variables for telemetry (Table 5)."""
        ...

    def anchor(self, belief: Belief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """The abstract state of now: what can be observed is read off the belief, the rest remembered."""
        ...

    def value(
        self,
        quantity: str,
        label: str,
        holds: tuple[Fact, ...],
        achieved: tuple[Fact, ...],
        belief: Belief,
        scenario: Scenario,
    ) -> Interval | None:
        """What the predicates over `label` say about a quantity of it (Algorithm 2, line 10).

        `holds` are predicates linked from the initial state, `achieved` those linked from earlier actions. None: they
        say nothing, and the parameter's default range stands. An empty intersection raises `Conflict`.
        """
        ...

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """The command as a message."""
        ...


class Conflict(Exception):
    """The predicates over a label exclude each other; the instantiation has failed with this reason."""
