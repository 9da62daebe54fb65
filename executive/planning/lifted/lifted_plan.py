"""The lifted partial plan: as the ground one, but with variables in its literals, and with bindings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from tailor.executive.planning.lifted.bindings import Bindings
from tailor.executive.planning.lifted.effects import Guard
from tailor.executive.planning.lifted.formula import Equality, LiftedDisjunction, LiftedFormula, LiftedLiteral, of_step
from tailor.executive.planning.lifted.schema import Schema
from tailor.executive.planning.lifted.task import LiftedTask, PlacedEffect
from tailor.executive.planning.structures.connectives import FALSE, Disjunction, conjuncts
from tailor.executive.planning.structures.orderings import GOAL, GOAL_STEP, Orderings


class LiftedLink(NamedTuple):
    """A causal link; see `partial_plan.Link`."""

    producer: int
    literal: LiftedLiteral
    first: int
    last: int
    rest: LiftedLink | None


class LiftedCondition(NamedTuple):
    """An open condition: a literal or a disjunction; see `partial_plan.OpenCondition`."""

    condition: LiftedLiteral | LiftedDisjunction
    first: int
    last: int
    rest: LiftedCondition | None


class LiftedThreat(NamedTuple):
    """An effect at `node` that unifies with the negation of a link's literal and may come within the link.

    `guards` are those of the effect in its schema.
    """

    link: LiftedLink
    node: int
    effect: LiftedLiteral
    guards: tuple[Guard, ...]
    rest: LiftedThreat | None


class LiftedPlan(NamedTuple):
    """Steps, orderings, bindings, links and flaws. Step i is `steps[i - 1]`; its variables are tagged with i."""

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
    choices = {(v.name, GOAL_STEP): task.world.choices(v) for v in task.goal_variables}
    bindings = Bindings().with_variables(choices)
    empty = LiftedPlan((), task.ground.initial_orderings(), bindings, None, None, None, 0, 0, 0)
    plan = opened(empty, of_step(task.goal, GOAL_STEP), GOAL, GOAL)
    return plan or empty._replace(open=LiftedCondition(FALSE, GOAL, GOAL, None), open_count=1)


def opened(plan: LiftedPlan, formula: LiftedFormula, first: int, last: int) -> LiftedPlan | None:
    """The plan with a formula's parts as newest open conditions, the first at the head.

    An equality is added to the bindings; None if these become inconsistent.
    """
    cell, count, bindings = plan.open, plan.open_count, plan.bindings
    parts: tuple[LiftedFormula, ...] = conjuncts(formula)
    for part in reversed(parts):
        if isinstance(part, Equality):
            bound = bindings.equated(*part)
            if bound is None:
                return None
            bindings = bound
        elif isinstance(part, LiftedLiteral | Disjunction):
            cell, count = LiftedCondition(part, first, last, cell), count + 1
    return plan._replace(open=cell, open_count=count, bindings=bindings)


def effects_of(task: LiftedTask, plan: LiftedPlan) -> Iterator[PlacedEffect]:
    """All effects in a plan, newest step first, timed literals last."""
    for step in range(len(plan.steps), 0, -1):
        yield from task.effects_of(plan.steps[step - 1], step)
    yield from reversed(task.timed)


def unifying(literal: LiftedLiteral, effect: LiftedLiteral, bindings: Bindings, negated: bool = False) -> bool:
    """Whether an effect unifies with a literal, or with its negation."""
    return (
        literal.predicate == effect.predicate
        and (literal.positive != effect.positive) == negated
        and bindings.may_unify(zip(effect.terms, literal.terms, strict=True))
    )


def opposing(literal: LiftedLiteral, effect: LiftedLiteral, bindings: Bindings) -> bool:
    """Whether an effect unifies with the negation of a literal."""
    return unifying(literal, effect, bindings, negated=True)
