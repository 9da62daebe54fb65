"""Gathers what an action's success beside objects of its context is learned from: one object in each episode.

Controllers know nothing of these objects. So a run without any tells of every object which it would have met, and one
run gives many episodes. They share their number's quotient by `objects`: training keeps those of one run together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array
from tailor.models.episodes.episodes import TICK_S, Episode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Message
from tailor.simnodes.body import Body
from tailor.tools.lockstep.action_run import run_action
from tailor.tools.lockstep.samplers.beside import Beside
from tailor.tools.lockstep.task_sampler import TaskSampler, sampler_of

PLACING = ("context", "context_start")  # methods that put an object there before a run


@runtime_checkable
class ObjectSampler(Protocol):
    """What a robot's task sampler adds for actions with a context."""

    def sample_among_objects(self, action: Action, rng: np.random.Generator) -> Array:
        """Return random controller arguments, shape (k,), of lengths that occur among objects."""
        ...

    def beside(self, action: Action, truths: Sequence[Message], count: int, rng: np.random.Generator) -> list[Beside]:
        """Return `count` random objects of the action's context, as a run met or passed them.

        Args:
          action: An action with a context.
          truths: Ground truth at each tick of the run.
          count: Number of objects.
          rng: Source of every draw.
        """
        ...


def object_sampler(domain: Domain) -> ObjectSampler:
    """The domain's task sampler, which draws objects.

    Raises:
      UsageError: It draws none, or the robot's package has no sampler.
    """
    sampler: object = sampler_of(domain)
    if not isinstance(sampler, ObjectSampler):
        kind = type(sampler).__name__
        raise UsageError(f"the sampler {kind} of {domain.name} lacks `sample_among_objects` or `beside`, expected both")
    return sampler


def check_sampler(domain: Domain, objects: int) -> None:
    """Check that the domain's task sampler draws objects: some noted after each run, or, with 0, one before it.

    Raises:
      UsageError: It lacks a method for that, or the robot's package has no sampler.
    """
    if objects:
        object_sampler(domain)
        return
    kind = type(sampler_of(domain))
    lacking = [name for name in PLACING if getattr(kind, name, None) in (None, getattr(TaskSampler, name))]
    if lacking:
        lacks = " and ".join(f"`{name}`" for name in lacking)
        raise UsageError(f"the sampler {kind.__name__} of {domain.name} lacks {lacks}, expected both")


def runs_beside_objects(
    objects: int,
    domain: Domain,
    name: str,
    body: Body,
    numbers: Sequence[int],
    rng_of: Callable[[int], np.random.Generator],
) -> tuple[list[Episode], float]:
    """Run an action once a number; `objects` episodes of each run, and the simulated seconds."""
    action, episodes, simulated_s = domain.actions[name], [], 0.0
    sampler = object_sampler(domain)
    for number in numbers:
        rng = rng_of(number)
        run = run_action(body, domain, name, sampler.sample_among_objects(action, rng), rng, traced=True)
        simulated_s += run.duration_s
        truths, (drawing,) = [tick.truth for tick in run.trace], rng_of(number).spawn(1)
        for k, each in enumerate(sampler.beside(action, truths, objects, drawing)):
            arguments = np.concatenate([run.ticks[each.tick], each.row])
            remaining_s = run.duration_s - TICK_S * each.tick
            episodes.append(
                Episode(
                    number * objects + k,
                    arguments,
                    arguments[None, :],
                    remaining_s,
                    not each.failure,
                    each.failure,
                    run.done,
                )
            )
    return episodes, simulated_s
