"""The partial plan of lifted search: as the ground one, but literals have variables and there are bindings."""

from __future__ import annotations

from typing import NamedTuple

from executive.planning.lifted.bindings import Bindings
from executive.planning.lifted.schema import LiftedEffect, LiftedLiteral, Schema
from executive.planning.lifted.task import LiftedTask
from executive.planning.orderings import GOAL, Closure, Orderings
from executive.planning.temporal_network import TemporalNetwork


class LiftedLink(NamedTuple):
    """A causal link; see `partial_plan.Link`."""

    producer: int
    literal: LiftedLiteral
    first: int
    last: int
    rest: LiftedLink | None


class LiftedCondition(NamedTuple):
    """An open condition; see `partial_plan.OpenCondition`."""

    literal: LiftedLiteral
    first: int
    last: int
    rest: LiftedCondition | None


class LiftedThreat(NamedTuple):
    """An effect at `node` that may become the opposite of a link's literal, and may fall into the link."""

    link: LiftedLink
    node: int
    effect: LiftedLiteral
    rest: LiftedThreat | None


class LiftedPlan(NamedTuple):
    """Steps, orderings, bindings, links, flaws. Step i is `steps[i - 1]`; its variables are tagged with i."""

    steps: tuple[Schema, ...]
    orderings: Orderings
    bindings: Bindings
    links: LiftedLink | None
    open: LiftedCondition | None
    threats: LiftedThreat | None
    open_count: int
    threat_count: int
    cost: float


def initial_plan(task: LiftedTask) -> LiftedPlan:
    """The plan without steps whose open conditions are the goal, the first at the head."""
    orderings: Orderings = TemporalNetwork.start(()) if task.moments == 2 else Closure()
    cell: LiftedCondition | None = None
    for literal in reversed(task.goal):
        cell = LiftedCondition(literal, GOAL, GOAL, cell)
    return LiftedPlan((), orderings, Bindings(), None, cell, None, len(task.goal), 0, 0)


def effects_of(plan: LiftedPlan, step: int) -> tuple[LiftedEffect, ...]:
    """The effects of a step's schema; instantiate literals with `of_step`."""
    return plan.steps[step - 1].effects


def unifying(literal: LiftedLiteral, effect: LiftedLiteral, bindings: Bindings) -> bool:
    """Whether an effect may become this very literal."""
    return (
        literal.predicate == effect.predicate
        and literal.positive == effect.positive
        and bindings.may_unify(zip(effect.terms, literal.terms, strict=True))
    )


def opposing(literal: LiftedLiteral, effect: LiftedLiteral, bindings: Bindings) -> bool:
    """Whether an effect may become the opposite of a literal."""
    return unifying(literal, effect._replace(positive=not effect.positive), bindings)
