"""Refinements of a lifted open condition: a new step, an old step or the initial state, each with its bindings."""

from __future__ import annotations

import itertools

from tailor.executive.planning.lifted.achievers import initial_achievers, new_achievers, old_achievers
from tailor.executive.planning.lifted.bindings import Bindings
from tailor.executive.planning.lifted.effects import Guard, LiftedEffect
from tailor.executive.planning.lifted.formula import LiftedLiteral, of_step, tagged
from tailor.executive.planning.lifted.lifted_plan import (
    LiftedCondition,
    LiftedLink,
    LiftedPlan,
    effects_of,
    opened,
)
from tailor.executive.planning.lifted.schema import Schema
from tailor.executive.planning.lifted.task import LiftedTask, PlacedEffect
from tailor.executive.planning.lifted.threat_detection import threatened, threatened_by_step
from tailor.executive.planning.structures.connectives import Disjunction
from tailor.executive.planning.structures.linked_list import without
from tailor.executive.planning.structures.orderings import INITIAL, Orderings


def refine_condition(task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition) -> list[LiftedPlan]:
    """All resolvers of an open condition: new steps by name, old steps (newest first), initial facts in their order.

    Each part of a disjunction is one resolver.
    """
    rest = plan._replace(open=without(plan.open, flaw), open_count=plan.open_count - 1)
    if isinstance(flaw.condition, Disjunction):
        parts = (opened(rest, part, flaw.first, flaw.last) for part in flaw.condition.parts)
        return [child for child in parts if child is not None]
    literal = flaw.condition
    new = (
        _by_new_step(task, rest, flaw, literal, *achiever) for achiever in new_achievers(task, plan.bindings, literal)
    )
    old = (_by_old_step(task, rest, flaw, literal, placed) for placed in old_achievers(task, plan, flaw, literal))
    start = (
        _linked(task, rest._replace(bindings=bindings), flaw, literal, INITIAL, plan.orderings)
        for bindings in initial_achievers(task, plan.bindings, literal)
    )
    return [child for child in itertools.chain(new, old, start) if child is not None]


# --- achievers -----------------------------------------------------------------------------------
def _by_new_step(
    task: LiftedTask,
    plan: LiftedPlan,
    flaw: LiftedCondition,
    literal: LiftedLiteral,
    schema: Schema,
    effect: LiftedEffect,
) -> LiftedPlan | None:
    if _is_of_others(effect.literal, literal):
        return None
    step = len(plan.steps) + 1
    node = len(plan.orderings.late)
    bindings = _bound(task, plan.bindings, schema, step)
    bindings = bindings and _achieving(bindings, effect, step, literal)
    orderings = plan.orderings.with_step(schema, effect.moment, flaw.first)
    if bindings is None or orderings is None:
        return None
    grown = _guarded(plan._replace(bindings=bindings), effect.guards, step, node)
    if grown is None:
        return None
    cell = grown.open
    for condition, (first, last) in reversed(schema.conditions):
        part = of_step(condition, step)
        assert isinstance(part, LiftedLiteral | Disjunction)
        cell = LiftedCondition(part, node + first, node + last, cell)
    grown = grown._replace(
        steps=(*plan.steps, schema),
        open=cell,
        open_count=grown.open_count + len(schema.conditions),
        cost=plan.cost + task.costs[schema],
    )
    child = _linked(task, grown, flaw, literal, node + effect.moment, orderings)
    return threatened_by_step(task, child, task.effects_of(schema, step), plan.links)


def _is_of_others(effect: LiftedLiteral, literal: LiftedLiteral) -> bool:
    """Whether an effect of a schema names another object: "forall" makes thousands of such effects."""
    pairs = zip(effect.terms, literal.terms, strict=True)
    return any(isinstance(b, str) and isinstance(a, str) and a != b and a[0] != "?" for a, b in pairs)


def _bound(task: LiftedTask, bindings: Bindings, schema: Schema, step: int) -> Bindings | None:
    """The bindings with the variables of a new step and the schema's equalities."""
    choices = {(p.name, step): task.world.choices(p) for p in (*schema.parameters, *schema.variables)}
    if not all(choices.values()):
        return None
    bound: Bindings | None = bindings.with_variables(choices)
    for left, right, same in schema.equalities:
        bound = bound and bound.equated(tagged(left, step), tagged(right, step), same)
    for name, value in schema.fixed.items():
        bound = bound and bound.equated((name, step), value, True)
    return bound


def _achieving(bindings: Bindings, effect: LiftedEffect, step: int, literal: LiftedLiteral) -> Bindings | None:
    """The bindings with an effect unified with a literal and not a no-op."""
    terms = effect.literal.of_step(step).terms
    bound = bindings.unified(zip(terms, literal.terms, strict=True))
    for left, right in effect.apart:
        bound = bound and bound.separated(tagged(left, step), tagged(right, step))
    return bound


def _guarded(plan: LiftedPlan, guards: tuple[Guard, ...], step: int, node: int) -> LiftedPlan | None:
    """The plan with an effect's guards as open conditions of its step; `node` is the step's first."""
    grown: LiftedPlan | None = plan
    for guard in reversed(guards):
        first, last = guard.span
        grown = grown and opened(grown, of_step(guard.holds, step), node + first, node + last)
    return grown


def _by_old_step(
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, literal: LiftedLiteral, placed: PlacedEffect
) -> LiftedPlan | None:
    node, step, _, effect = placed
    orderings = plan.orderings if node == flaw.first else plan.orderings.ordered(node, flaw.first)
    bindings = _achieving(plan.bindings, effect, step, literal)
    if orderings is None or bindings is None:
        return None
    grown = _guarded(plan._replace(bindings=bindings), effect.guards, step, node - effect.moment)
    return grown and _linked(task, grown, flaw, literal, node, orderings)


# --- links --------------------------------------------------------------------------------------
def _linked(
    task: LiftedTask,
    plan: LiftedPlan,
    flaw: LiftedCondition,
    literal: LiftedLiteral,
    producer: int,
    orderings: Orderings,
) -> LiftedPlan:
    """The plan with one more link and the threats to it; the oldest step's threat ends at the head."""
    link = LiftedLink(producer, literal, flaw.first, flaw.last, plan.links)
    grown = plan._replace(orderings=orderings, links=link)
    if literal.predicate in task.world.static:
        return grown
    return threatened(task, grown, effects_of(task, grown), link)
