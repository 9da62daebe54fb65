"""Interface of an executable action: parameters, controller, models (paper 4.1, Table 6)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from tailor.executive.interfaces.values import Array, Belief, Spans

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


class SubgoalRisk(Protocol):
    """Risk that the way to an asserted subgoal spoils the action after it: the robot hits the ball, say."""

    def __call__(self, subgoals: Array, action: Array) -> Array:
        """Risks, shape (n,), 0 to 1, of a subgoal action's parameters, shape (n, p), before an action's, shape (q,)."""
        ...


def unchanged(values: Array) -> Array:
    """The values themselves: what an action asks of its models is its parameters."""
    return values


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
    subgoal_action: str = ""  # the action put before this one when it is predicted to fail (Algorithm 3)
    subgoal_risk: SubgoalRisk | None = None  # that the way to the subgoal spoils this action; None: it cannot
    arguments: Callable[[Array], Array] = unchanged
    spans: Spans | None = None  # `arguments` on intervals, for certificates; None: unknown, unless nothing is changed
    time_limit_factor: float = 3.0  # times the predicted duration
    time_limit_floor_s: float = 10.0
