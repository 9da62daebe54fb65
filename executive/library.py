"""The action library: executable actions, their parameters, and the domain that declares them.

These are the only words that core, planning and refinement share with a domain (paper 4.1, Table 6).
A domain folder fills them in; nothing here knows a robot.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.schemas.messages import Message, Sample

Array = NDArray[np.float64]
Fact = tuple[str, ...]  # a ground atom: ("robot", "pos1")
Belief = Any  # a domain's own frozen value


@dataclass(frozen=True, slots=True)
class Interval:
    """A closed range of values, lower <= upper; a bound value is a range of one point."""

    lower: float
    upper: float


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of an executable action.

    `argument` is the index of the PDDL argument that it belongs to (Algorithm 2, line 8), `quantity` what is asked
    of that label ("x", "phi", ...): parameters with one label and one quantity are one variable.
    `tolerance` is how far the believed value may move while the action runs before the executive thinks again.
    """

    name: str
    argument: int
    quantity: str
    unit: str
    lower: float
    upper: float
    periodic: bool = False  # wraps around at the ends of its range
    tolerance: float | None = None  # None: it may move as it likes


Columns = tuple[Array, ...]  # one array a parameter or argument; they broadcast to one shape
Spans = Callable[[Columns, Columns], tuple[Columns, Columns]]  # lower and upper ends to lower and upper ends
Outcome = Literal["running", "done", "failed"]


@dataclass(frozen=True, slots=True)
class Control:
    """What a controller answers: its new memory, the command (one float an axis), and how it stands."""

    memory: Any
    command: tuple[float, ...]
    outcome: Outcome = "running"
    reason: str = ""


class Controller(Protocol):
    """A pure, deterministic control program; `memory` is None at the first call."""

    def __call__(self, memory: Any, now_ns: int, belief: Belief, arguments: Array) -> Control:
        """One 10 Hz step towards `arguments`, shape (k,): the controller's arguments, see Action.arguments."""
        ...


def unchanged(values: Array) -> Array:
    """The values themselves: what an action asks of its models is its parameters."""
    return values


class DetourRisk(Protocol):
    """What a detour may do to the action that it is made for: run into its ball, say."""

    def __call__(self, detours: Array, action: Array) -> Array:
        """Risks, shape (n,), 0 to 1, of a detour's parameters, shape (n, p), before an action's, shape (q,)."""
        ...


@dataclass(frozen=True, slots=True)
class Action:
    """An executable action: what a symbolic action turns into.

    `arguments` maps action parameters, shape (n, p), to what controller and models take, shape (n, k): an approach
    whose parameters name the ball becomes a pose of the robot behind it.
    """

    name: str
    parameters: tuple[Parameter, ...]
    controller: Controller
    duration_model: str  # "goToPose/duration": path in the robot's model zoo
    success_model: str = ""  # empty: never predicted to fail
    detour: str = ""  # the action put before this one when it is predicted to fail (Algorithm 3)
    detour_risk: DetourRisk | None = None  # that the detour itself spoils this action; None: it cannot
    arguments: Callable[[Array], Array] = unchanged
    spans: Spans | None = None  # `arguments` on intervals, for certificates; None: unknown, unless nothing is changed
    time_limit_factor: float = 3.0  # times the predicted duration
    time_limit_floor_s: float = 10.0


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


class DurationModel(Protocol):
    """Predicts how long an action takes."""

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Mean and standard deviation in seconds, shape (n,), for arguments of shape (n, k); NaN is invalid."""
        ...


class SuccessModel(Protocol):
    """Predicts whether an action succeeds."""

    def probability(self, arguments: Array) -> Array:
        """Probability of success, shape (n,), for arguments of shape (n, k); NaN is invalid."""
        ...


class RefinementGate(Protocol):
    """Predicts whether refinement would slow an episode down (paper 6.3.2)."""

    @property
    def asks(self) -> tuple[str, ...]:
        """Names of the values that it is told, in order."""
        ...

    @property
    def sequences(self) -> frozenset[tuple[str, ...]]:
        """Kinds of sequences that it was learned for: names of actions, detours left out."""
        ...

    @property
    def threshold(self) -> float:
        """Above this risk the greedy choice is kept."""
        ...

    def slower(self, situations: Array) -> Array:
        """Risk that refining costs time, 0..1, shape (n,), of situations (n, k); NaN is invalid."""
        ...


class ModelBounds(Protocol):
    """What a model says at least or at most while each of its arguments lies between two values.

    Models that know theirs have them as `bounds`; without, nothing can be proven about a choice.
    """

    def least(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """The least mean plus `k_std` standard deviations."""
        ...

    def most(self, lower: Columns, upper: Columns) -> Array:
        """The largest mean."""
        ...

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """The same for arguments that lie between these: quicker to compute."""
        ...

    @property
    def effort(self) -> int:
        """Elementary comparisons that one bound takes, roughly."""
        ...


@dataclass(frozen=True, slots=True)
class Models:
    """The loaded action models of one robot, by zoo path ("goToPose/duration").

    `benefit` advises against refinement where it would cost time; None: always refine.
    """

    durations: Mapping[str, DurationModel]
    successes: Mapping[str, SuccessModel]
    benefit: RefinementGate | None = None
