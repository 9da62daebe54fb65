"""Interface of an executable action: parameters, controller, models (paper 4.1, Table 6)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from tailor.executive.interfaces.action_context import ActionContext
from tailor.executive.interfaces.values import Array, Belief, Spans

Outcome = Literal["running", "done", "failed"]


@dataclass(frozen=True, slots=True)
class Control:
    """Result of one controller step.

    Attributes:
      state: Controller state, passed to the next step.
      command: One value per axis of the outlets that the action drives, in the domain's order and units. The executive
        clamps it to the axis limits.
      outcome: "done" and "failed" end the action in this tick.
      detail: Cause of a failure, for people; it becomes the detail of Reason.CONTROLLER_FAILED.
    """

    state: Any
    command: tuple[float, ...]
    outcome: Outcome = "running"
    detail: str = ""


class Controller(Protocol):
    """A pure, deterministic control program, called at 10 Hz."""

    def __call__(self, state: Any, now_ns: int, belief: Belief, arguments: Array) -> Control:
        """One control step.

        Args:
          state: Controller state of the step before; None in the first step of an action. An immutable value.
          now_ns: Monotonic time of this tick.
          belief: The domain's belief state, predicted to `now_ns`.
          arguments: Values of Action.arguments, shape (k,), in the units of the domain's parameters.

        Returns:
          The next controller state, the command and the outcome. A command that is not finite fails the action.
        """
        ...


class SubgoalRisk(Protocol):
    """Risk that an asserted subgoal spoils the action for which it is asserted, e.g. by touching that action's ball."""

    def __call__(self, subgoals: Array, action: Array) -> Array:
        """Risk of each candidate.

        Args:
          subgoals: Parameters of the action that reaches the subgoal, shape (n, p), one row per candidate.
          action: Parameters of the action that follows, shape (q,).

        Returns:
          Risks from 0 to 1, shape (n,).
        """
        ...


def unchanged(values: Array) -> Array:
    """Identity, for actions whose parameters are the arguments of controller and models."""
    return values


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of an executable action.

    Parameters of a plan with one label and one quantity are one variable.

    Attributes:
      name: Unique within the action.
      argument: Index of the PDDL argument whose label the parameter refines (Algorithm 2, line 8).
      quantity: Quantity of that label, e.g. "x" or "phi"; Domain.value is queried for it.
      unit: "m", "rad", "m/s", "rad/s", "1"; "m" marks a place.
      lower: Lower end of the default range.
      upper: Upper end of the default range.
      periodic: Whether the ends of the default range are the same value.
      tolerance: Change of the believed value, in `unit`, beyond which a running action is deliberated anew; None: any
        change is accepted. Of a free parameter: how far its value may lie outside of its range; None: a tenth of it.
    """

    name: str
    argument: int
    quantity: str
    unit: str
    lower: float
    upper: float
    periodic: bool = False
    tolerance: float | None = None

    @property
    def period(self) -> float:
        """After which values are the same again, in `unit`; infinite if they never are."""
        return self.upper - self.lower if self.periodic else math.inf


@dataclass(frozen=True, slots=True)
class Action:
    """An executable action, to which a symbolic action is mapped.

    Attributes:
      name: Executable name, e.g. "goToPose".
      parameters: In the order in which `arguments`, `subgoal_risk` and the models expect them.
      controller: Control program.
      duration_model: Path in the robot's model zoo, e.g. "goToPose/duration".
      success_model: The same for success; empty: never predicted to fail.
      subgoal_action: Name of the action that is put before this one when it is predicted to fail (Algorithm 3); perhaps
        its own: a copy with a free goal. An action that has one starts well from anywhere on its way, so it may also be
        left there: it is, once a fact is lost that the plan needs.
      subgoal_risk: Risk that the subgoal spoils this action; None: there is no such risk.
      arguments: Maps parameters, shape (n, p), to the arguments of controller and models, shape (n, k). An example: a
        parameter names the ball's place, the argument is the pose behind it.
      spans: `arguments` on intervals, for certificates. None: unknown, unless `arguments` is `unchanged`.
      drives: Names of the command outlets that the action drives; empty: all. What it does not drive rests: zero, or
        the last set-point of an axis that keeps it.
      context: Objects near which the action may fail; None: there are none.
      time_limit_factor: Times the predicted duration; a longer action fails.
      time_limit_floor_s: Minimum of that limit, seconds.
    """

    name: str
    parameters: tuple[Parameter, ...]
    controller: Controller
    duration_model: str
    success_model: str = ""
    subgoal_action: str = ""
    subgoal_risk: SubgoalRisk | None = None
    arguments: Callable[[Array], Array] = unchanged
    spans: Spans | None = None
    context: ActionContext | None = None
    drives: tuple[str, ...] = ()
    time_limit_factor: float = 3.0
    time_limit_floor_s: float = 10.0
