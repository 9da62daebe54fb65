"""The actions that a plan became, and the search for the best values of their free parameters."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Parameter:
    """An instantiated action parameter; equal ids are one variable (paper 6.2.2)."""

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
    """An executable action with its parameters and what its model predicts for the chosen values."""

    action: str
    step: int
    asserted: bool
    predicted_s: float
    spread_s: float
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Subgoals:
    """The action sequence that is being executed, with the chosen values of its free parameters."""

    stamp_ns: int
    tick: int
    horizon: int
    actions: tuple[InstantiatedAction, ...] = ()


@dataclass(frozen=True, slots=True)
class RefinementReport:
    """The refinement's search: what greedy would have cost, the best so far, and what it took; -1 s is INVALID."""

    stamp_ns: int
    tick: int
    horizon: int
    solver: str
    finished: bool
    evaluations: int
    checks: int
    greedy_s: float
    best_s: float
    trace_evaluations: tuple[int, ...] = ()
    trace_best_s: tuple[float, ...] = ()
    situation: tuple[float, ...] = ()  # what a benefit tree sees of both choices; its card names the values
    p_slowdown: float = -1.0  # the tree's risk that refining costs time, 0..1 (paper 6.3.2); -1: it was not asked
    kept_greedy: bool = False  # the tree advised against refining
    gap_pct: float = -1.0  # proven: best_s is at most so much above the models' optimum; -1: not certified
