"""Data sets of random episodes: what each draws."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.domain import Domain
from tailor.tools.lockstep import action_run

TRAINING_STREAM, EVALUATION_STREAM, NOISE_STREAM, POLICY_STREAM = 10, 11, 12, 13  # first word of every seed
UNCERTAIN_STREAM = 15  # active_episodes.py has 14


@dataclass(frozen=True, slots=True)
class DataSetSpec:
    """One data set to gather: episodes of one action with random arguments.

    With `objects` of the action's context, each run gives as many episodes: see `beside_objects.py`.
    """

    domain: str
    action: str
    episodes: int
    seed: int
    folder: Path
    stream: int = TRAINING_STREAM
    beside: bool = False  # each episode beside one random object of the action's context
    objects: int = 0
    profile: str = ""  # of the body; empty: the one that ships

    def rng(self, number: int) -> np.random.Generator:
        """Random generator of one episode: its arguments and all its noise."""
        return np.random.default_rng([self.stream, self.seed, zlib.crc32(self.action.encode()), number])


def draw(spec: DataSetSpec, domain: Domain, rng: np.random.Generator) -> NDArray[np.float64]:
    """Arguments of one episode, with the row of its object if there is one."""
    arguments = action_run.sample_arguments(domain, spec.action, rng)
    return action_run.with_object(domain, spec.action, arguments, rng) if spec.beside else arguments


def argument_names(domain: Domain, action: str) -> list[str]:
    """Names of the controller's arguments."""
    return [parameter.name for parameter in domain.actions[action].parameters]


def columns_of(spec: DataSetSpec, domain: Domain) -> list[dict[str, str]]:
    """Name and unit of the action's arguments; then those of the object beside it."""
    action = domain.actions[spec.action]
    named = [{"name": parameter.name, "unit": parameter.unit} for parameter in action.parameters]
    objects = action.context.columns if spec.beside and action.context is not None else ()
    return [*named, *({"name": column.name, "unit": column.unit} for column in objects)]
