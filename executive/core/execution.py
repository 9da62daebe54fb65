"""The running action: its controller's memory, its clock, and how it ends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.interfaces.action import Action, Control
from tailor.executive.interfaces.values import Array, Belief


@dataclass(frozen=True, slots=True)
class Running:
    """An action in execution with the values chosen for its parameters."""

    action: Action
    step: int  # id of the plan step that it serves
    asserted: bool  # leads to an asserted subgoal: its end does not complete the plan step
    parameters: tuple[float, ...]
    predicted_s: float
    started_ns: int
    memory: Any = None

    def elapsed_s(self, now_ns: int) -> float:
        """Seconds since the action started."""
        return (now_ns - self.started_ns) / 1e9

    def time_limit_s(self) -> float:
        """When to give up: predicted duration times the action's factor, but at least its floor."""
        predicted = self.predicted_s if np.isfinite(self.predicted_s) else 0.0
        return max(self.action.time_limit_floor_s, self.action.time_limit_factor * predicted)


def control_step(running: Running, now_ns: int, belief: Belief) -> tuple[Running, Control]:
    """One step of the action's controller; running out of time is a failure."""
    control = running.action.controller(running.memory, now_ns, belief, controller_arguments(running))
    if control.outcome == "running" and running.elapsed_s(now_ns) > running.time_limit_s():
        reason = f"{running.action.name} took longer than {running.time_limit_s():.1f} s"
        control = replace(control, outcome="failed", reason=reason)
    return replace(running, memory=control.memory), control


def controller_arguments(running: Running) -> Array:
    """What the controller takes, shape (k,), from the action's parameters."""
    row = np.asarray([running.parameters], dtype=np.float64)
    arguments: Array = running.action.arguments(row)[0]
    return arguments
