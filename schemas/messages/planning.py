"""How the executive comes by its plans, and what it asks and hears of an external planner."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PlanReport:
    """A plan in VHPOP's causal-link form, and how the executive came by it."""

    stamp_ns: int
    status: str  # solved unsolvable limit unsupported, failed (the external planner)
    way: str  # "searched", "suffix", "improved" (found while the action before it ran), "external"
    plan: str
    generated: int
    visited: int
    reason: str


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """What the executive asks its external planner: PDDL of the domain, and of the problem from the facts of now."""

    stamp_ns: int
    id: int
    domain: str
    problem: str


@dataclass(frozen=True, slots=True)
class PlanAnswer:
    """How the external planner ended, as it was handed to the executive's core: an input, recorded for replay."""

    stamp_ns: int
    id: int  # of the request
    outcome: str  # "answered", "crashed", "timeout", "flood", "missing"
    output: str  # what it printed, if it answered: not believed yet
    reason: str
