"""What the run of one action yields: duration, outcome, training examples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.action import Action, Control
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.messages import Message
from tailor.simnodes.body import Reading
from tailor.tools.lockstep.readings import judged
from tailor.tools.lockstep.task_sampler import TaskSampler


@dataclass(frozen=True, slots=True)
class Tick:
    """One traced tick of an action run."""

    time_s: float
    belief: Belief
    truth: Message
    command: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ActionRun:
    """One execution of one action.

    Attributes:
      action: Its name.
      arguments: Controller arguments, shape (k,).
      ticks: Controller arguments with the belief of each 10 Hz tick in place of the start, shape (T, k).
      duration_s: Time until the controller reported its goal.
      success: No failure.
      failure: "", the sampler's ("collision"), "time limit", or the controller's own reason.
      done: The controller reached its goal, even if a collision makes the run a failure.
      work_j: Joules of the drives from each tick to the next, shape (T,); 0 at the last.
      trace: Beliefs, ground truth and commands; empty unless `traced`.
    """

    action: str
    arguments: Array
    ticks: Array
    duration_s: float
    success: bool
    failure: str
    done: bool
    work_j: Array
    trace: tuple[Tick, ...] = ()


class ActionLog:
    """Notes of one run of an action, tick by tick.

    Args:
      sampler: Judges ground truth, and reads the belief.
      action: The action that runs.
      arguments: Its controller arguments, shape (k,).
      row: Row of the object beside it; empty without one.
      start: The body's start state.
      traced: Also keep beliefs, ground truth and commands.
    """

    def __init__(
        self,
        sampler: TaskSampler,
        action: Action,
        arguments: Array,
        row: list[float],
        start: Mapping[str, float],
        traced: bool,
    ) -> None:
        self._sampler, self._action, self._start = sampler, action, start
        self._arguments, self._row, self._traced = arguments, row, traced
        self._failure = ""
        self._examples: list[list[float]] = []
        self._work: list[float] = []
        self._trace: list[Tick] = []

    def note(self, now_ns: int, belief: Belief, truth: Message, command: tuple[float, ...]) -> None:
        """A tick: belief, true state and command."""
        self._failure = self._failure or self._sampler.failure(self._action, self._start, truth)
        self._examples.append([*self._sampler.arguments_now(self._action, belief, self._arguments), *self._row])
        if self._traced:
            self._trace.append(Tick(now_ns * 1e-9, belief, truth, command))

    def moved(self, readings: Sequence[Reading], before: Message, after: Message) -> None:
        """The way from one tick to the next: readings, and the true states at its ends."""
        self._failure = self._failure or judged(self._sampler, self._action, self._start, readings)
        self._work.append(self._sampler.work_j(before, after))

    def run(self, control: Control, now_ns: int) -> ActionRun:
        """The whole run, which ended at `now_ns` with the controller's last answer."""
        done = control.outcome == "done"
        failure = self._failure or ("" if done else control.detail or "time limit")
        ticks, work_j = np.array(self._examples), np.array([*self._work, 0.0])[: len(self._examples)]
        run = self._arguments, ticks, now_ns * 1e-9, not failure, failure, done, work_j, tuple(self._trace)
        return ActionRun(self._action.name, *run)
