"""Runs of single actions in lock-step: body, belief and controller in one process.

They yield the random episodes that action models learn from (paper 5.1). `run.py` runs the whole executive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from tailor.executive.interfaces.action import Action, Control
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import at_rest, completed
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.installed import part, spec_of
from tailor.schemas.messages import ActionFinished, Message, Sample
from tailor.schemas.topics import TOPICS
from tailor.simnodes.body import Body, Reading

PERIOD_NS = 100_000_000  # 10 Hz
TIME_LIMIT_S = 40.0  # an action that takes longer has failed


class TaskSampler(Protocol):
    """What a robot adds to the sampling of its actions and to the reading of its runs.

    `arguments` are controller arguments, shape (k,); see `Action.arguments`. A subclass needs the first four methods;
    the others have defaults for a robot that has no objects around it and no model of its energy.
    """

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Return random controller arguments, shape (k,)."""
        ...

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """Return the body's start state for controller arguments; what they leave open is drawn from `rng`."""
        ...

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> Belief:
        """Return a noisy belief state of the robot at that start."""
        ...

    def arguments_now(self, action: Action, belief: Belief, arguments: Array) -> list[float]:
        """Return the controller arguments with the believed state in place of the start."""
        ...

    def context(self, action: Action, arguments: Array, rng: np.random.Generator) -> Array:
        """Return one random object near the way, as it is believed: a row of the action's context, shape (c,).

        Needed only for actions that have a context.
        """
        raise NotImplementedError(f"{type(self).__name__} draws no objects for {action.name}")

    def context_start(self, action: Action, row: Array, rng: np.random.Generator) -> dict[str, float]:
        """Return the part of the body's start state that puts the object there, off by the belief's error."""
        raise NotImplementedError(f"{type(self).__name__} puts no objects near {action.name}")

    def work_j(self, before: Message, after: Message) -> float:
        """Return the work of the drives between two states of motion in joules; NaN for other messages."""
        return math.nan

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """Return the failure that the ground truth shows, or ""."""
        return ""

    def start_names(self, action: Action, parameters: Array) -> Mapping[str, str]:
        """Return the belief values that start parameters stand for, where their names differ.

        Args:
          action: An executable action of the domain.
          parameters: Values of its parameters, shape (p,).
        """
        return {}

    def motion(self, message: Message, newest: Message | None) -> Message | None:
        """Return the newest state of motion after a message: the ground truth, else what the sensors measured."""
        return newest

    def observed_start(self, message: Message) -> dict[str, float] | None:
        """Return what `failure` compares with, from the first ground truth of an action; None for other messages."""
        return None

    def contacts(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> int:
        """Return the number of contacts in a run that should not have happened, e.g. collisions."""
        return 0

    def arrival_errors(self, action: Action, arguments: Array, truth: Message) -> Mapping[str, float]:
        """Return the deviation of the true state from the goal at the end of an action; empty if it is not known.

        Args:
          action: An executable action of the domain.
          arguments: Its controller arguments, shape (k,).
          truth: Ground truth at its end.

        Returns:
          Errors by name with unit, e.g. {"position_m": 0.03, "heading_rad": -0.1}; their absolute values count.
        """
        return {}

    def disturbance_m(self, finished: Sequence[ActionFinished], truth: Sequence[Message]) -> float:
        """Return how far an object was displaced before the first action that may disturb it had ended, metres."""
        return 0.0


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


def sample_arguments(domain: Domain, action_name: str, rng: np.random.Generator) -> Array:
    """Random controller arguments of an action, shape (k,), within its declared ranges.

    Raises:
      KeyError: The domain has no such action.
    """
    return sampler_of(domain).sample(domain.actions[action_name], rng)


def with_object(domain: Domain, action_name: str, arguments: Array, rng: np.random.Generator) -> Array:
    """Controller arguments, shape (k,), followed by the row of one random object of the action's context: (k + c,)."""
    return np.concatenate([arguments, sampler_of(domain).context(domain.actions[action_name], arguments, rng)])


def new_body(domain: Domain) -> Body:
    """A simulated body of the domain's robot. Reuse it for every run: making one is slow.

    Raises:
      UsageError: The robot's package has no body.
    """
    body: Body = part(spec_of(domain.name), "body")()
    return body


def sampler_of(domain: Domain) -> TaskSampler:
    """The domain's task sampler.

    Raises:
      UsageError: The robot's package has no sampler.
    """
    sampler: TaskSampler = part(spec_of(domain.name), "sampler")()
    return sampler


def run_action(
    body: Body,
    domain: Domain,
    action_name: str,
    arguments: Array,
    rng: np.random.Generator,
    *,
    limit_s: float = TIME_LIMIT_S,
    traced: bool = False,
) -> ActionRun:
    """Run one action from its start state until it is done, has failed, or the time limit is reached.

    Args:
      body: Reset here, with noise from `rng`.
      domain: Provides the controller and the belief filter.
      action_name: An executable action of the domain.
      arguments: Controller arguments, shape (k,): state at the start and at the goal; perhaps followed by one row of
        the action's context, shape (k + c,).
      rng: Source of all noise. Equal arguments and generator states give equal runs, bit for bit.
      limit_s: Limit of the simulated time.
      traced: Also keep beliefs, ground truth and commands.

    Returns:
      The run with its duration, outcome and the training examples of all its ticks.
    """
    action, sampler = domain.actions[action_name], sampler_of(domain)
    arguments, row = np.split(arguments, [len(action.parameters)])
    start = sampler.start(action, arguments, rng)
    if len(row):
        start = start | sampler.context_start(action, row, rng)
    belief = sampler.belief(start, rng)
    body.reset(rng, start)
    log = _Log(sampler, action, arguments, row.tolist(), start, traced)
    state: Any = None
    truth, command = body.ground_truth(), at_rest(domain.axes)
    for tick in range(int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        control = action.controller(state, now_ns, belief, arguments)
        command = completed(domain, action, control.command, command)
        log.note(now_ns, belief, truth, command)
        if control.outcome != "running":
            break
        state = control.state
        body.command(command)
        readings = body.advance(PERIOD_NS)
        belief = domain.update(belief, now_ns + PERIOD_NS, newest(readings), command)
        before, truth = truth, body.ground_truth()
        log.moved(readings, before, truth)
    return log.run(control, now_ns)


class _Log:
    """What a run of an action yields, noted tick by tick.

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


def judged(sampler: TaskSampler, action: Action, start: Mapping[str, float], readings: Sequence[Reading]) -> str:
    """The first failure that the simulator's readings of one tick show, or ""."""
    truths = (reading.message for reading in readings if _source(reading.topic) == "simulator")
    return next((failure for truth in truths if (failure := sampler.failure(action, start, truth))), "")


def newest(readings: Sequence[Reading]) -> tuple[Sample, ...]:
    """The newest sensor reading of each topic, as a subscriber of queue depth one receives it."""
    last = {reading.topic: reading for reading in readings}
    return tuple(
        Sample(reading.topic, reading.message, reading.time_ns, 0)
        for reading in sorted(last.values(), key=lambda reading: reading.time_ns)
        if _source(reading.topic) == "driver"
    )


@lru_cache(maxsize=256)
def _source(topic: str) -> str:
    """Who publishes a topic; looked up for every reading."""
    return TOPICS[topic].source
