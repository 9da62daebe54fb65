"""Costs of a run besides time, as the ground truth shows them: contacts, energy, errors of arrival."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import ActionFinished, Message, Subgoals
from tailor.tools.lockstep.episode_extraction import arguments_of
from tailor.tools.lockstep.run import Run
from tailor.tools.lockstep.task_sampler import sampler_of


@dataclass(frozen=True, slots=True)
class Costs:
    """Costs of one run.

    Attributes:
      contacts: Number of contacts that should not have happened.
      energy_j: Work of the drives during the actions; NaN if it is not known.
      arrival: Mean absolute error at the ends of its finished actions, by name with unit.
      further: Costs that only this robot has, by name: see `further_costs` of its task sampler.
    """

    contacts: int
    energy_j: float
    arrival: tuple[tuple[str, float], ...]
    further: tuple[tuple[str, float], ...] = ()


NO_COSTS = Costs(0, float("nan"), ())


def costs_of(run: Run, domain: Domain) -> Costs:
    """Costs of a run of a domain."""
    sampler = sampler_of(domain)
    contacts = sampler.contacts(run.finished, run.truth)
    known = getattr(sampler, "further_costs", None)  # a sampler need not have any
    further = known(run.truth) if known is not None else {}
    return Costs(contacts, _energy_j(run, domain), _arrival(run, domain), tuple(sorted(further.items())))


def _energy_j(run: Run, domain: Domain) -> float:
    """Work from the start of the first finished action to the end of the last one."""
    if not run.finished:
        return 0.0
    work_j, first, last = sampler_of(domain).work_j, run.finished[0], run.finished[-1]
    stamped: list[Any] = _motions(run, domain)
    begun_ns = first.stamp_ns - round(first.actual_s * 1e9)
    during = [state for state in stamped if begun_ns <= state.stamp_ns <= last.stamp_ns]
    if not during:  # the robot's sampler knows no states of motion
        return float("nan")
    return float(sum(work_j(before, after) for before, after in itertools.pairwise(during)))


def _arrival(run: Run, domain: Domain) -> tuple[tuple[str, float], ...]:
    errors: dict[str, list[float]] = defaultdict(list)
    sampler = sampler_of(domain)
    for action, arguments, truth in _arrivals(run, domain):
        for name, error in sampler.arrival_errors(action, arguments, truth).items():
            errors[name].append(abs(error))
    return tuple((name, float(np.mean(found))) for name, found in sorted(errors.items()))


def _arrivals(run: Run, domain: Domain) -> Iterator[tuple[Action, Array, Message]]:
    """Each action that was done: its last arguments, shape (k,), and the ground truth at its end."""
    truths = {id(message) for message in _motions(run, domain)}
    truth: Message | None = None
    subgoals: Subgoals | None = None
    for message in run.messages:
        if id(message) in truths:
            truth = message
        elif isinstance(message, Subgoals):
            subgoals = message
        elif isinstance(message, ActionFinished) and message.outcome == "done" and truth and subgoals:
            first = subgoals.actions[0] if subgoals.actions else None
            if first is not None and first.action == message.action:
                action = domain.actions[message.action]
                yield action, arguments_of(action, first), truth


def _motions(run: Run, domain: Domain) -> list[Message]:
    """The robot's own true states; a simulator may publish others beside them."""
    sampler = sampler_of(domain)
    return [message for message in run.truth if sampler.motion(message, None) is message]
