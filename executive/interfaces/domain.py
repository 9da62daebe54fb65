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


@dataclass(frozen=True, slots=True)
class LabelQuery:
    """Query for the range of one quantity of one label of a plan.

    Attributes:
      quantity: As declared by Parameter.quantity, e.g. "x" or "phi".
      label: PDDL object, e.g. "pos2".
      holds: Ground predicates over the label that are linked from the initial state, in the order of the plan's links.
      achieved: Those that are linked from earlier actions, in the same order.
      belief: The domain's belief state.
      scenario: Places and settings of the task.
    """

    quantity: str
    label: str
    holds: tuple[Fact, ...]
    achieved: tuple[Fact, ...]
    belief: Belief
    scenario: Scenario


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

    def value(self, query: LabelQuery) -> Interval | None:
        """Range of a quantity of a label, as its predicates restrict it (Algorithm 2, line 10).

        Args:
          query: Quantity, label, the predicates over the label, belief and scenario.

        Returns:
          The intersection of the ranges that the predicates give, in the unit of the parameters with this quantity.
          A range of one point binds the variable. None if no predicate restricts it: the default range of the
          parameter applies.

        Raises:
          Conflict: The intersection is empty, or a value that the predicates need is not in the belief.
        """
        ...

    def message(self, command: tuple[float, ...], stamp_ns: int) -> Message:
        """The command as a message."""
        ...


class Conflict(Exception):
    """The predicates over a label exclude each other; the instantiation has failed with this reason."""
