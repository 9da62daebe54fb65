"""Single actions in lock-step: a body, a belief and a controller joined in one process, as fast as it goes.

This is where episodes to learn from come from (paper 5.1). The whole executive in lock-step is episodes.py.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.messages import Message, Sample
from tailor.schemas.topics import TOPICS
from tailor.simnodes.body import Body, Reading

PERIOD_NS = 100_000_000  # 10 Hz
LIMIT_S = 40.0  # an action that takes longer has failed
BODIES = {"soccer": "tailor.simnodes.agilo.body:AgiloBody", "arm": "tailor.simnodes.powercube.body:PowerCubeBody"}
SAMPLERS = {
    "soccer": "tailor.tools.lockstep.samplers.soccer:SoccerSampler",
    "arm": "tailor.tools.lockstep.samplers.arm:ArmSampler",
}


class TaskSampler(Protocol):
    """How a robot's actions are tried out."""

    def sample(self, action: Action, rng: np.random.Generator) -> Array:
        """Random controller arguments, shape (k,)."""
        ...

    def start(self, action: Action, arguments: Array, rng: np.random.Generator) -> dict[str, float]:
        """The body's start state for controller arguments, give or take what these do not tell."""
        ...

    def belief(self, start: Mapping[str, float], rng: np.random.Generator) -> Belief:
        """What the robot believes in that state."""
        ...

    def arguments_now(self, action: Action, belief: Belief, arguments: Array) -> list[float]:
        """Controller arguments with the believed state in place of the start."""
        ...

    def work_j(self, before: Message, after: Message) -> float:
        """Joules that the drives have taken between two true states; NaN if that cannot be told."""
        ...

    def failure(self, action: Action, start: Mapping[str, float], truth: Message) -> str:
        """What has gone wrong in the world by now, or ""."""
        ...


@dataclass(frozen=True, slots=True)
class Tick:
    """One tick of an episode."""

    time_s: float
    belief: Belief
    truth: Message
    command: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ActionRun:
    """One execution of one action.

    `failure` is "" or what went wrong: "collision" (the ball was knocked away; the action may still have ended),
    "time limit", or the controller's own reason. `success` is: no failure.
    """

    action: str
    arguments: Array  # (k,), controller arguments
    ticks: Array  # (T, k), controller arguments with the belief of each 10 Hz tick in place of the start
    duration_s: float  # until the controller said done
    success: bool
    failure: str
    done: bool  # the controller reached its goal, whatever else happened
    work_j: Array  # (T,), joules of the drives from each tick to the next; 0 at the last
    trace: tuple[Tick, ...] = ()  # only if asked for


def sample_arguments(domain: Domain, action_name: str, rng: np.random.Generator) -> Array:
    """Random controller arguments of an action, shape (k,), from the ranges that it declares."""
    return sampler_of(domain).sample(domain.actions[action_name], rng)


def new_body(domain: Domain) -> Body:
    """A body for the domain's robot; use it again for every episode."""
    body: Body = _named(BODIES[domain.name])()
    return body


def sampler_of(domain: Domain) -> TaskSampler:
    """The domain's trials."""
    made: TaskSampler = _named(SAMPLERS[domain.name])()
    return made


def run_action(
    body: Body,
    domain: Domain,
    action_name: str,
    arguments: Array,
    rng: np.random.Generator,
    *,
    limit_s: float = LIMIT_S,
    traced: bool = False,
) -> ActionRun:
    """Run one action from its start state until it is done, has failed, or time is up.

    Args:
      body: Reset here, with noise from `rng`.
      domain: Gives controller and belief.
      action_name: An executable action of the domain.
      arguments: Controller arguments, shape (k,): state at the start and at the goal.
      rng: All noise. The same arguments and generator state give the same episode, bit for bit.
      limit_s: Seconds of simulated time.
      traced: Keep beliefs, truth and commands too.
    """
    action, trials = domain.actions[action_name], sampler_of(domain)
    start = trials.start(action, arguments, rng)
    belief = trials.belief(start, rng)
    body.reset(rng, start)
    memory: Any = None
    failure, rows, work, trace = "", [], [], []
    truth = body.ground_truth()
    for tick in range(int(limit_s * 1e9) // PERIOD_NS):
        now_ns = tick * PERIOD_NS
        failure = failure or trials.failure(action, start, truth)
        rows.append(trials.arguments_now(action, belief, arguments))
        control = action.controller(memory, now_ns, belief, arguments)
        if traced:
            trace.append(Tick(now_ns * 1e-9, belief, truth, control.command))
        if control.outcome != "running":
            break
        memory = control.memory
        body.command(control.command)
        readings = body.advance(PERIOD_NS)
        belief = domain.update(belief, now_ns + PERIOD_NS, newest(readings), control.command)
        before, truth = truth, body.ground_truth()
        work.append(trials.work_j(before, truth))
    done = control.outcome == "done"
    failure = failure or ("" if done else control.reason or "time limit")
    ticks, worked = np.array(rows), np.array([*work, 0.0])[: len(rows)]
    return ActionRun(action_name, arguments, ticks, now_ns * 1e-9, not failure, failure, done, worked, tuple(trace))


def newest(readings: Sequence[Reading]) -> tuple[Sample, ...]:
    """The newest sensor reading of each topic, as a ring of depth one hands it over on the bus."""
    last = {reading.topic: reading for reading in readings}
    return tuple(
        Sample(reading.topic, reading.message, reading.time_ns, 0)
        for reading in sorted(last.values(), key=lambda reading: reading.time_ns)
        if TOPICS[reading.topic].source == "driver"
    )


def _named(path: str) -> Any:
    module, name = path.split(":")
    return getattr(importlib.import_module(module), name)
