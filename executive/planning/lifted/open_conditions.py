"""Refining a lifted open condition: a new step, an old one or the initial state, each with its bindings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.lifted.bindings import Bindings, Term
from tailor.executive.planning.lifted.effects import Guard, LiftedEffect
from tailor.executive.planning.lifted.formula import LiftedLiteral, of_step, tagged
from tailor.executive.planning.lifted.lifted_plan import (
    LiftedCondition,
    LiftedLink,
    LiftedPlan,
    effects_of,
    opened,
    unifying,
)
from tailor.executive.planning.lifted.schema import Schema
from tailor.executive.planning.lifted.task import Achiever, LiftedTask, PlacedEffect
from tailor.executive.planning.lifted.threat_detection import threatened, threatened_by_step
from tailor.executive.planning.structures.connectives import Disjunction
from tailor.executive.planning.structures.linked_list import without
from tailor.executive.planning.structures.orderings import INITIAL, Orderings

MAX_ABSENT = 2_500  # facts that a negative condition with free variables is tried on: a tenth of a second


def refine_condition(task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition) -> list[LiftedPlan]:
    """All plans that mend the flaw: new steps by name, old steps newest first, then initial facts in their order.

    Of a disjunction each part is one way.
    """
    rest = plan._replace(open=without(plan.open, flaw), open_count=plan.open_count - 1)
    if isinstance(flaw.condition, Disjunction):
        parts = (opened(rest, part, flaw.first, flaw.last) for part in flaw.condition.parts)
        return [child for child in parts if child is not None]
    literal = flaw.condition
    new = (_by_new_step(task, rest, flaw, literal, *found) for found in new_achievers(task, plan.bindings, literal))
    old = (_by_old_step(task, rest, flaw, literal, found) for found in old_achievers(task, plan, flaw, literal))
    start = (
        _linked(task, rest._replace(bindings=bindings), flaw, literal, INITIAL, plan.orderings)
        for bindings in initial_achievers(task, plan.bindings, literal)
    )
    return [child for child in itertools.chain(new, old, start) if child is not None]


def new_achievers(task: LiftedTask, bindings: Bindings, literal: LiftedLiteral) -> Iterator[Achiever]:
    """Schemata with an effect of the literal's predicate and sign, whose fixed parameters fit."""
    for schema, effect in task.achievers.get((literal.predicate, literal.positive), ()):
        if not schema.fixed or _fits(schema, effect, bindings, literal):
            yield schema, effect


def _fits(schema: Schema, effect: LiftedEffect, bindings: Bindings, literal: LiftedLiteral) -> bool:
    fixed = (schema.fixed.get(str(term)) for term in effect.literal.terms)
    return all(name is None or bindings.may_equal(term, name) for name, term in zip(fixed, literal.terms, strict=True))


def old_achievers(
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, literal: LiftedLiteral
) -> Iterator[PlacedEffect]:
    """Effects in the plan that may become the condition's literal and may come before it, the newest step's first."""
    late = plan.orderings.late[flaw.first]
    if flaw.first != flaw.last:
        late ^= 1 << flaw.first  # the action's own start may make true what it needs over all
    for placed in effects_of(task, plan):
        if not late >> placed.node & 1 and unifying(literal, placed.literal, plan.bindings):
            yield placed


def initial_achievers(task: LiftedTask, bindings: Bindings, literal: LiftedLiteral) -> Iterator[Bindings]:
    """The bindings with which a literal holds in the initial state; for a negative one by closed world.

    Raises:
      TooMuchToGround: A negative literal has more than MAX_ABSENT instances.
    """
    facts = task.initial.get(literal.predicate, ())
    if literal.positive:
        for fact in facts:
            bound = bindings.unified(zip(literal.terms, fact[1:], strict=True))
            if bound is not None:
                yield bound
        return
    absent = set(facts)
    objects = [_objects(task, bindings, term) for term in literal.terms]
    if math.prod(len(names) for names in objects) > MAX_ABSENT:
        raise TooMuchToGround(f"'not {literal.predicate}' has more than {MAX_ABSENT} instances")
    for names in itertools.product(*objects):
        if (literal.predicate, *names) not in absent:
            bound = bindings.unified(zip(literal.terms, names, strict=True))
            if bound is not None:
                yield bound


def _objects(task: LiftedTask, bindings: Bindings, term: Term) -> tuple[str, ...]:
    value = bindings.value(term)
    if value is not None:
        return (value,)
    return tuple(name for name in task.world.objects["object"] if bindings.may_equal(term, name))


# --- the ways ------------------------------------------------------------------------------------
def _by_new_step(
    task: LiftedTask,
    plan: LiftedPlan,
    flaw: LiftedCondition,
    literal: LiftedLiteral,
    schema: Schema,
    effect: LiftedEffect,
) -> LiftedPlan | None:
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


def _bound(task: LiftedTask, bindings: Bindings, schema: Schema, step: int) -> Bindings | None:
    """The bindings with the variables of a new step and what the schema says of them."""
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
    """The bindings with which an effect becomes a literal, and is no no-op."""
    terms = effect.literal.of_step(step).terms
    bound = bindings.unified(zip(terms, literal.terms, strict=True))
    for left, right in effect.apart:
        bound = bound and bound.separated(tagged(left, step), tagged(right, step))
    return bound


def _guarded(plan: LiftedPlan, guards: tuple[Guard, ...], step: int, node: int) -> LiftedPlan | None:
    """The plan with an effect's guards as open conditions of its step, whose first node is given."""
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
    """The plan with one more link, and the threats to it: newest step first, so that the oldest ends at the head."""
    link = LiftedLink(producer, literal, flaw.first, flaw.last, plan.links)
    grown = plan._replace(orderings=orderings, links=link)
    if literal.predicate in task.world.static:
        return grown
    return threatened(task, grown, effects_of(task, grown), link)
