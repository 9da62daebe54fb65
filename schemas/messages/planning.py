"""Plans, and the exchange with an external planner."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class PlanReport(Message):
    """A plan in VHPOP's causal-link form, and its source."""

    stamp_ns: int
    status: str  # solved, unsolvable, limit, unsupported, failed (the external planner)
    way: str  # searched, suffix, improved (found during the action before it), external
    plan: str
    generated: int
    visited: int
    reason: str  # empty if there is a plan
    detail: str = ""  # of the reason


@dataclass(frozen=True, slots=True)
class PlanRequest(Message):
    """Request of the executive to its external planner."""

    stamp_ns: int
    id: int
    domain: str  # PDDL
    problem: str  # PDDL, from the current facts


@dataclass(frozen=True, slots=True)
class PlanAnswer(Message):
    """Result of the external planner, as handed to the executive's core: an input, recorded for replay."""

    stamp_ns: int
    id: int  # of the request
    outcome: str  # answered, crashed, timeout, flood, missing
    output: str  # of the planner, if it answered; parsed and validated before use
    reason: str
