"""Tasks of an arm with a gripper: stretches from rest to rest, one after the other, and waits for the gripper.

After a failure the arm comes home before that is reported: a robot that drives with its arm out hits furniture.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from tailor.executive.actions.cubic import Joints
from tailor.executive.actions.reach import JointBelief, Reach
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array


class ArmBelief(JointBelief, Protocol):
    """A belief that also knows the gripper's width, and the force with which it presses."""

    @property
    def width(self) -> float: ...  # noqa: D102

    @property
    def force(self) -> float: ...  # noqa: D102


Target = Callable[[Any, Array], Joints | None]  # joint angles from belief and arguments; None: out of reach


@dataclass(frozen=True, slots=True)
class Stretch:
    """One part of a task: the arm moves to a target, or rests without one, while the gripper goes to a width.

    Attributes:
      target: Angles to move to; None: rest.
      width: Set-point of the gripper, m; None: the task drives no gripper.
      rest_s: Minimum duration of a rest.
      failed: What is wrong at the end of the stretch, from the belief; "": nothing.
      goes_on: Whether the arm, at the end, moves on to the target of now before the next stretch, from the belief, the
        arguments and the angles that it has moved to.
    """

    target: Target | None
    width: float | None = None
    rest_s: float = 0.0
    failed: Callable[[Any], str] = lambda belief: ""
    goes_on: Callable[[Any, Array, Joints], bool] = lambda belief, arguments, reached: False


@dataclass(frozen=True, slots=True)
class Progress:
    """Controller state: the stretch that is under way, its goal, and what has gone wrong before."""

    number: int
    started_ns: int
    goal: Joints | None = None
    motion: Any = None
    failure: str = ""


@dataclass(frozen=True, slots=True)
class ArmTask:
    """Goes through its stretches; the last one brings the arm home, also after a failure of another.

    Attributes:
      reach: Controller of the arm.
      stretches: In their order.
      fastest_radps: Limit of each joint.
      homing: Whether the last stretch brings the arm home.
      refused: Why the task does not begin, from the belief and the arguments; "": it does.
      kept: Set-point at which the gripper of a task that does not begin stays as it is, m.
    """

    reach: Reach
    stretches: tuple[Stretch, ...]
    fastest_radps: float
    homing: bool = True
    refused: Callable[[Any, Array], str] = lambda belief, arguments: ""
    kept: Callable[[Any], float] = lambda belief: float(belief.width)

    def __call__(self, state: Any, now_ns: int, belief: ArmBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; velocities of the joints, rad/s, then the width, m."""
        progress = state if isinstance(state, Progress) else self._entered(0, now_ns, belief, arguments, "")
        if progress is None or progress.number >= len(self.stretches):
            return Control(state, self._still(belief), "failed", "out of reach")
        if progress is not state and (refusal := self.refused(belief, arguments)):
            return Control(state, self._still(belief), "failed", refusal)
        stretch, last = self.stretches[progress.number], progress.number == len(self.stretches) - 1
        progress, velocities, ended = self._advanced(progress, stretch, now_ns, belief)
        command = velocities if stretch.width is None else (*velocities, stretch.width)
        if not ended:
            return Control(progress, command)
        failure = progress.failure or stretch.failed(belief)
        if last or (failure and not self.homing):
            return Control(progress, command, "failed" if failure else "done", failure)
        again = progress.goal is not None and stretch.goes_on(belief, arguments, progress.goal)
        number = len(self.stretches) - 1 if failure else progress.number + (not again)
        return Control(self._entered(number, now_ns, belief, arguments, failure) or progress, command)

    def _entered(self, number: int, now_ns: int, belief: ArmBelief, arguments: Array, failure: str) -> Progress | None:
        """A stretch at its start; the last one if its target is out of reach, None if it is the first."""
        target = self.stretches[number].target
        goal = target(belief, arguments) if target is not None else None
        if target is None or goal is not None:
            return Progress(number, now_ns, goal, None, failure)
        if number == 0 or number == len(self.stretches) - 1 or not self.homing:
            return None
        return self._entered(len(self.stretches) - 1, now_ns, belief, arguments, failure or "out of reach")

    def _advanced(
        self, progress: Progress, stretch: Stretch, now_ns: int, belief: ArmBelief
    ) -> tuple[Progress, Joints, bool]:
        """The stretch one period on: its state, the joints' velocities, and whether it has ended."""
        if progress.goal is None:
            rested = (now_ns - progress.started_ns) * 1e-9 >= stretch.rest_s
            return progress, (0.0,) * len(belief.angles), rested
        waypoint = [value for angle in progress.goal for value in (angle, 0.0)]
        control = self.reach(progress.motion, now_ns, belief, np.array([*waypoint, *waypoint]))
        most = self.fastest_radps
        velocities = tuple(max(-most, min(most, velocity)) for velocity in control.command)
        return replace(progress, motion=control.state), velocities, control.outcome == "done"

    def _still(self, belief: ArmBelief) -> tuple[float, ...]:
        rest = (0.0,) * len(belief.angles)
        return rest if self.stretches[-1].width is None else (*rest, self.kept(belief))
