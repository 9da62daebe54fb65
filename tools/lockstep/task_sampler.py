"""Task sampler: what a robot adds to the sampling of its actions and to the reading of its runs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array, Belief
from tailor.schemas.installed import part, spec_of
from tailor.schemas.messages import ActionFinished, Message


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


def sampler_of(domain: Domain) -> TaskSampler:
    """The domain's task sampler.

    Raises:
      UsageError: The robot's package has no sampler.
    """
    sampler: TaskSampler = part(spec_of(domain.name), "sampler")()
    return sampler
