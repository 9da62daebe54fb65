"""Instantiated actions of a plan, and the search for the values of their free parameters."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class Parameter:
    """Parameter of an instantiated action; equal ids are one variable (paper 6.2.2)."""

    name: str
    id: int
    label: str
    unit: str
    bound: bool
    lower: float
    upper: float
    value: float


@dataclass(frozen=True, slots=True)
class InstantiatedAction:
    """Executable action with its parameters and the prediction of its model for the chosen values."""

    action: str
    step: int
    asserted: bool
    predicted_s: float
    spread_s: float  # standard deviation
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Subgoals(Message):
    """Action sequence in execution, with the chosen values of its free parameters."""

    stamp_ns: int
    tick: int
    horizon: int
    actions: tuple[InstantiatedAction, ...] = ()


@dataclass(frozen=True, slots=True)
class ActionObjects:
    """Objects near which an action may fail, as its success model gets them: one row of numbers for each."""

    action: str
    columns: tuple[str, ...] = ()  # names
    values: tuple[float, ...] = ()  # row by row, SI units

    @property
    def rows(self) -> tuple[tuple[float, ...], ...]:
        """The numbers of each object; the last row of a damaged message may be too short."""
        width = max(1, len(self.columns))
        return tuple(self.values[first : first + width] for first in range(0, len(self.values), width))


@dataclass(frozen=True, slots=True)
class Contexts(Message):
    """Objects of the sequence that the Subgoals of the same tick report; published only if there are any."""

    stamp_ns: int
    tick: int
    contexts: tuple[ActionObjects, ...] = ()


@dataclass(frozen=True, slots=True)
class RefinementReport(Message):
    """State of the refinement's search; a duration of -1 s is INVALID."""

    stamp_ns: int
    tick: int
    horizon: int
    solver: str
    finished: bool
    evaluations: int
    checks: int
    greedy_s: float  # predicted duration of the greedy choice
    best_s: float  # predicted duration of the best choice so far
    trace_evaluations: tuple[int, ...] = ()  # parallel to trace_best_s
    trace_best_s: tuple[float, ...] = ()
    gap_pct: float = -1.0  # certified: best_s is at most this much above the models' optimum; -1: not certified
