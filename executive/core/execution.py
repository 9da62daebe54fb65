"""The running action: parameters, controller state, time limit, outcome."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.core.command_guard import fault_of_control
from tailor.executive.deliberation.deliberation import Decision
from tailor.executive.interfaces.action import Action, Control
from tailor.executive.interfaces.models import DurationModel, Models
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.errors import UsageError


@dataclass(frozen=True, slots=True)
class Running:
    """An action in execution with the values chosen for its parameters."""

    action: Action
    step: int  # id of the plan step that it serves
    asserted: bool  # an asserted subgoal: its end does not complete the plan step
    parameters: tuple[float, ...]
    predicted_s: float
    started_ns: int
    controller_state: Any = None
    interval_s: tuple[float, float] | None = None  # that the duration lies in with 90 %; None: the model has none
    first_s: float | None = None  # predicted at its start, if it was redirected since
    longest_s: float = 0.0  # of what was predicted to be left when it was redirected
    unsupported: int = 0  # ticks in a row for which a fact has been missing that the plan needs
    is_lost: bool = False  # whether one has been missing for so long that another plan is searched for
    lost: Cause | None = None  # the last such fact

    def elapsed_s(self, now_ns: int) -> float:
        """Seconds since the action started."""
        return (now_ns - self.started_ns) / 1e9

    def time_limit_s(self) -> float:
        """Seconds until the action fails: predicted duration times the action's factor, but at least its floor.

        A robot that is stuck is redirected again and again if what it drives to moves: each time is not another limit.
        """
        most_s = np.inf if self.first_s is None else self.first_s + self.longest_s
        predicted_s = min(self.predicted_s, most_s) if np.isfinite(self.predicted_s) else 0.0
        return max(self.action.time_limit_floor_s, self.action.time_limit_factor * predicted_s)

    def surprise(self, now_ns: int) -> str:
        """Text if the action, which ends now, took less or more than its interval; empty otherwise."""
        if self.interval_s is None or self.interval_s[0] <= self.elapsed_s(now_ns) <= self.interval_s[1]:
            return ""
        lower_s, upper_s = self.interval_s
        return f"outside of {max(lower_s, 0.0):.1f}..{upper_s:.1f} s, the predicted 90 % interval"

    def redirected(self, following: Running, made_ns: int) -> Running:
        """The next values of the same action, which goes on; its predictions count from its start.

        `made_ns` is the time of the belief that they were predicted from.
        """
        elapsed_s, interval_s = max(0.0, self.elapsed_s(made_ns)), following.interval_s
        return replace(
            following,
            started_ns=self.started_ns,
            predicted_s=elapsed_s + following.predicted_s,
            interval_s=interval_s and (elapsed_s + interval_s[0], elapsed_s + interval_s[1]),
            first_s=self.predicted_s if self.first_s is None else self.first_s,
            longest_s=max(self.longest_s, following.predicted_s if np.isfinite(following.predicted_s) else 0.0),
        )


def control_step(running: Running, now_ns: int, belief: Belief, package: str) -> tuple[Running, Control, Cause | None]:
    """One step of the action's controller; an action beyond its time limit has failed.

    Args:
      running: The action.
      now_ns: Monotonic time of this tick.
      belief: The domain's belief state.
      package: Whose controller it is, for people: the domain's name.

    Returns:
      The running action with its next controller state, the control, and the cause of a failure.

    Raises:
      UsageError: The controller returned no well-formed Control; no retry would correct that.
    """
    control = running.action.controller(running.controller_state, now_ns, belief, controller_arguments(running))
    fault = fault_of_control(control)
    if fault:
        raise UsageError(f"the package of {package}: the controller of {running.action.name} returned {fault}")
    cause = Cause(Reason.CONTROLLER_FAILED, control.detail) if control.outcome == "failed" else None
    if control.outcome == "running" and running.elapsed_s(now_ns) > running.time_limit_s():
        control = replace(control, outcome="failed")
        cause = Cause(Reason.ACTION_TIMEOUT, f"{running.time_limit_s():.1f} s")
    return replace(running, controller_state=control.state), control, cause


def controller_arguments(running: Running) -> Array:
    """The controller's arguments, shape (k,), from the action's parameters."""
    row = np.asarray([running.parameters], dtype=np.float64)
    arguments: Array = running.action.arguments(row)[0]
    return arguments


def first_action(decision: Decision, models: Models, now_ns: int) -> Running:
    """The first action of a decision, started at `now_ns` with the chosen values."""
    first = decision.sequence.actions[0]
    values = decision.choice.values
    variables = decision.sequence.variables
    parameters = tuple(_value(variables[i].value, values.get(i)) for i in first.variables)
    predicted_s = decision.choice.predicted_s[0]
    path = models.duration_path(first.action.duration_model, bool(first.context))
    interval_s = _interval_s(first.action, models.durations.get(path), parameters)
    return Running(first.action, first.step, first.asserted, parameters, predicted_s, now_ns, interval_s=interval_s)


def _interval_s(
    action: Action, model: DurationModel | None, parameters: tuple[float, ...]
) -> tuple[float, float] | None:
    """Interval of the duration with these parameters; None if the model has none, or gives no valid one."""
    if not getattr(model, "calibrated", False):
        return None
    _, (lower_s,), (upper_s,) = model.interval(action.arguments(np.asarray([parameters])))  # type: ignore[union-attr]
    return (float(lower_s), float(upper_s)) if np.isfinite(upper_s) else None


def _value(bound: float | None, chosen: float | None) -> float:
    if bound is not None:
        return bound
    assert chosen is not None, "a free parameter of the next action was not chosen"
    return chosen
