"""Interface that every domain implements: PDDL, executable actions, belief, values of the predicates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.values import Belief, Fact, Interval
from tailor.schemas.messages import Message, Sample


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a robot's command.

    Attributes:
      name: E.g. "omega".
      unit: E.g. "rad/s".
      lower: Minimum of the command; lower < 0 < upper, since zero brings the robot to rest.
      upper: Maximum of the command.
      kept: First set-point of an axis that keeps its last one while no action drives it, such as the width of a
        gripper; its range need not contain zero. None: zero brings the axis to rest.
    """

    name: str
    unit: str
    lower: float
    upper: float
    kept: float | None = None


@dataclass(frozen=True, slots=True)
class Scenario:
    """A task: initial abstract state and goal in PDDL, and the values of its labels.

    Attributes:
      name: E.g. "approach-dribble".
      problem: PDDL text of the problem.
      places: Known values by label and quantity, in the units of the domain's parameters (m and rad in the map frame),
        e.g. {"pos3": {"x": 0.0, "y": -1.0, "phi": 2.6}}.
      settings: Settings that the domain reads, by name.
    """

    name: str
    problem: str
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


Doubt = Callable[[Belief, Belief], bool]  # of the belief before and after a reading: whether it contradicts the first


class Domain(Protocol):
    """Interface that every domain implements. Every method is pure and deterministic.

    Attributes:
      name: Name of the domain's folder, e.g. "soccer".
      robot: Name of the robot; prefix of its topics' keys, e.g. "agilo".
      pddl: PDDL text of the domain.
      actions: Executable actions by name.
      executables: Executable name by PDDL action name (lower case).
      axes: Axes of the command. A robot with several command outlets also has an attribute `outlets`, see
        tailor.executive.interfaces.outlet; `command_topic` and `message` are then those of the first. One whose belief
        notices that the robot was carried to another place has a method `relocations`, one that knows messages of its
        sensors which cannot be true a method `measurement_fault`, one with axes that are kept a method `kept`, see
        tailor.executive.interfaces.domain_results.
      command_topic: Topic of the command, a key of tailor.schemas.topics.TOPICS.
      sensors: Topics from which the belief is estimated.
      required: Those sensors that must be fresh while the robot moves; the executive holds while one is stale.
      belief_names: Names of `belief_values`, with the unit in parentheses, e.g. "x (m)".
    """

    name: str
    robot: str
    pddl: str
    actions: Mapping[str, Action]
    executables: Mapping[str, str]
    axes: tuple[Axis, ...]
    command_topic: str
    sensors: tuple[str, ...]
    required: tuple[str, ...]
    belief_names: tuple[str, ...]

    def initial_belief(self) -> Belief:
        """The belief before the first percept."""
        ...

    def update(self, belief: Belief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]) -> Belief:
        """Estimate the belief at `now_ns`.

        Args:
          belief: Belief of the tick before.
          now_ns: Monotonic time of this tick; never less than in the tick before.
          samples: New samples of the `sensors`, oldest arrival first; perhaps none.
          command: The last published command, one value per axis.

        Returns:
          The belief, predicted to `now_ns`.
        """
        ...

    def ready(self, belief: Belief) -> bool:
        """Whether the belief suffices to plan and act; the executive holds until it does."""
        ...

    def belief_values(self, belief: Belief) -> tuple[float, ...]:
        """State variables of the belief for telemetry (Table 5): finite, in the order of `belief_names`.

        The last ones may be left out while there is nothing that they describe.
        """
        ...

    def anchor(self, belief: Belief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
        """The abstract state of now; also in each tick of an action that may be left on its way, so it is to be fast.

        Args:
          belief: The belief of now.
          scenario: Labels and settings of the task.
          remembered: The abstract state that follows from the executed actions.

        Returns:
          `remembered`, with every observable fact replaced by its value in the belief.
        """
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
        """The command as a message of the type of `command_topic`.

        Args:
          command: One finite value per axis, within its limits.
          stamp_ns: Stamp of the message.
        """
        ...


class Conflict(Exception):
    """The predicates over a label exclude each other, or a value is unknown; the instantiation fails with this text."""
