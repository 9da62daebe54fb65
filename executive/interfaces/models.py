"""Interfaces of action models: what the executive calls, whoever learned them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from tailor.executive.interfaces.values import Array, Columns


class DurationModel(Protocol):
    """Predicts how long an action takes."""

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Mean and standard deviation in seconds, shape (n,), for arguments of shape (n, k); NaN is invalid."""
        ...


class SuccessModel(Protocol):
    """Predicts whether an action succeeds."""

    def probability(self, arguments: Array) -> Array:
        """Probability of success, shape (n,), for arguments of shape (n, k); NaN is invalid."""
        ...


class RefinementGate(Protocol):
    """Predicts whether refinement would slow an episode down (paper 6.3.2)."""

    @property
    def input_names(self) -> tuple[str, ...]:
        """Names of the values that it is told, in order."""
        ...

    @property
    def sequences(self) -> frozenset[tuple[str, ...]]:
        """Kinds of sequences that it was learned for: names of actions, asserted subgoals left out."""
        ...

    @property
    def threshold(self) -> float:
        """Above this risk the greedy choice is kept."""
        ...

    def p_slowdown(self, situations: Array) -> Array:
        """Risk that refining costs time, 0..1, shape (n,), of situations (n, k); NaN is invalid."""
        ...


class ModelBounds(Protocol):
    """What a model says at least or at most while each of its arguments lies between two values.

    Models that know theirs have them as `bounds`; without, nothing can be proven about a choice.
    """

    def lower_bound(self, lower: Columns, upper: Columns, k_std: float = 0.0) -> Array:
        """The least mean plus `k_std` standard deviations."""
        ...

    def upper_bound(self, lower: Columns, upper: Columns) -> Array:
        """The largest mean."""
        ...

    def within(self, lower: Columns, upper: Columns) -> ModelBounds:
        """The same for arguments that lie between these: quicker to compute."""
        ...

    @property
    def effort(self) -> int:
        """Elementary comparisons that one bound takes, roughly."""
        ...


@dataclass(frozen=True, slots=True)
class Models:
    """The loaded action models of one robot, by zoo path ("goToPose/duration").

    `gate` advises against refinement where it would cost time; None: always refine.
    """

    durations: Mapping[str, DurationModel]
    successes: Mapping[str, SuccessModel]
    gate: RefinementGate | None = None
