"""Refining a lifted open condition: a new step, an old one or the initial state, each with its bindings."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from executive.planning.cells import without
from executive.planning.lifted.bindings import Bindings, Term
from executive.planning.lifted.lifted_plan import (
    LiftedCondition,
    LiftedLink,
    LiftedPlan,
    LiftedThreat,
    effects_of,
    opposing,
    unifying,
)
from executive.planning.lifted.schema import LiftedEffect, LiftedLiteral, Pairs, Schema
from executive.planning.lifted.task import LiftedTask
from executive.planning.orderings import INITIAL, Orderings


def refine_condition(task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition) -> list[LiftedPlan]:
    """All plans that mend the flaw: new steps by name, old steps newest first, then initial facts in their order."""
    rest = plan._replace(open=without(plan.open, flaw), open_count=plan.open_count - 1)
    new = (
        child
        for schema, effect in new_achievers(task, flaw.literal)
        for apart in effect.apart
        if (child := _by_new_step(task, rest, flaw, schema, effect, apart))
    )
    old = (
        child
        for step, effect in old_achievers(task, plan, flaw)
        for apart in effect.apart
        if (child := _by_old_step(task, rest, flaw, step, effect, apart))
    )
    start = (
        _linked(task, rest._replace(bindings=bindings), flaw, INITIAL, plan.orderings)
        for bindings in initial_achievers(task, plan.bindings, flaw.literal)
    )
    return [*new, *old, *start]


def new_achievers(task: LiftedTask, literal: LiftedLiteral) -> Iterator[tuple[Schema, LiftedEffect]]:
    """Schemata with an effect of the literal's predicate and sign."""
    for schema in task.schemata:
        for effect in schema.effects:
            if effect.literal.predicate == literal.predicate and effect.literal.positive == literal.positive:
                yield schema, effect


def old_achievers(task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition) -> Iterator[tuple[int, LiftedEffect]]:
    """Steps, newest first, with an effect that may become the condition and may come before it."""
    late = plan.orderings.late[flaw.first]
    if flaw.first != flaw.last:
        late ^= 1 << flaw.first  # the action's own start may make true what it needs over all
    for step in range(len(plan.steps), 0, -1):
        for effect in effects_of(plan, step):
            node = task.node_of(step) + effect.moment
            if not late >> node & 1 and unifying(flaw.literal, effect.literal.of_step(step), plan.bindings):
                yield step, effect


def initial_achievers(task: LiftedTask, bindings: Bindings, literal: LiftedLiteral) -> Iterator[Bindings]:
    """The bindings with which a literal holds in the initial state; for a negative one by closed world."""
    facts = task.initial.get(literal.predicate, ())
    if literal.positive:
        for fact in facts:
            bound = bindings.unified(zip(literal.terms, fact[1:], strict=True))
            if bound is not None:
                yield bound
        return
    absent = set(facts)
    for names in itertools.product(*(_objects(task, bindings, term) for term in literal.terms)):
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
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, schema: Schema, effect: LiftedEffect, apart: Pairs
) -> LiftedPlan | None:
    step = len(plan.steps) + 1
    node = len(plan.orderings.late)
    bindings = _bound(task, plan.bindings, schema, step)
    bindings = bindings and _achieving(bindings, effect, apart, step, flaw.literal)
    orderings = plan.orderings.with_step(schema, effect.moment, flaw.first)
    if bindings is None or orderings is None:
        return None
    cell = plan.open
    for literal, (first, last) in reversed(schema.conditions):
        cell = LiftedCondition(literal.of_step(step), node + first, node + last, cell)
    grown = plan._replace(
        steps=(*plan.steps, schema),
        bindings=bindings,
        open=cell,
        open_count=plan.open_count + len(schema.conditions),
        cost=plan.cost + task.costs[schema.name],
    )
    child = _linked(task, grown, flaw, node + effect.moment, orderings)
    return _with_threats_by(task, child, step, plan.links)


def _bound(task: LiftedTask, bindings: Bindings, schema: Schema, step: int) -> Bindings | None:
    """The bindings with the variables of a new step and what the schema says of them."""
    choices = {(p.name, step): task.world.choices(p) for p in schema.parameters}
    bound: Bindings | None = bindings.with_variables(choices)
    for left, right, same in schema.equalities:
        a, b = _tagged(left, step), _tagged(right, step)
        bound = bound and (bound.unified([(a, b)]) if same else bound.separated(a, b))
    return bound


def _tagged(name: str, step: int) -> Term:
    return (name, step) if name[0] == "?" else name


def _achieving(
    bindings: Bindings, effect: LiftedEffect, apart: Pairs, step: int, literal: LiftedLiteral
) -> Bindings | None:
    """The bindings with which an effect becomes a literal, and neither a no-op nor undone."""
    terms = effect.literal.of_step(step).terms
    bound = bindings.unified(zip(terms, literal.terms, strict=True))
    for left, right in apart:
        bound = bound and bound.separated(_tagged(left, step), _tagged(right, step))
    return bound


def _by_old_step(
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, step: int, effect: LiftedEffect, apart: Pairs
) -> LiftedPlan | None:
    node = task.node_of(step) + effect.moment
    orderings = plan.orderings if node == flaw.first else plan.orderings.ordered(node, flaw.first)
    bindings = _achieving(plan.bindings, effect, apart, step, flaw.literal)
    if orderings is None or bindings is None:
        return None
    return _linked(task, plan._replace(bindings=bindings), flaw, node, orderings)


# --- links and threats ---------------------------------------------------------------------------
def _linked(
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, producer: int, orderings: Orderings
) -> LiftedPlan:
    """The plan with one more link, and the threats to it: newest step first, so that the oldest ends at the head."""
    link = LiftedLink(producer, flaw.literal, flaw.first, flaw.last, plan.links)
    grown = plan._replace(orderings=orderings, links=link)
    if flaw.literal.predicate in task.world.static:
        return grown
    for step in range(len(plan.steps), 0, -1):
        grown = _threatened(task, grown, step, link)
    return grown


def _with_threats_by(task: LiftedTask, plan: LiftedPlan, step: int, links: LiftedLink | None) -> LiftedPlan:
    while links is not None:
        if links.literal.predicate not in task.world.static:
            plan = _threatened(task, plan, step, links)
        links = links.rest
    return plan


def _threatened(task: LiftedTask, plan: LiftedPlan, step: int, link: LiftedLink) -> LiftedPlan:
    """The plan with the threats of one step to one link."""
    for effect in effects_of(plan, step):
        literal = effect.literal.of_step(step)
        node = task.node_of(step) + effect.moment
        if opposing(link.literal, literal, plan.bindings):
            threat = LiftedThreat(link, node, literal, plan.threats)
            if is_threat(task, plan, threat):
                plan = plan._replace(threats=threat, threat_count=plan.threat_count + 1)
    return plan


def is_threat(task: LiftedTask, plan: LiftedPlan, threat: LiftedThreat) -> bool:
    """Whether the effect may still undo the link: by order, by bindings, and unless its own step restores it."""
    late, link, node = plan.orderings.late, threat.link, threat.node
    if node in (link.producer, link.last):
        return False  # the consumer may undo its condition; not at its start what it needs over all
    if late[link.last] >> node & 1 or late[node] >> link.producer & 1:
        return False
    if not opposing(link.literal, threat.effect, plan.bindings):
        return False
    step = task.step_of(node)
    return threat.effect.positive or not any(
        effect.literal.positive
        and task.node_of(step) + effect.moment == node
        and effect.literal.predicate == link.literal.predicate
        and not plan.bindings.differing(zip(effect.literal.of_step(step).terms, link.literal.terms, strict=True))
        for effect in effects_of(plan, step)
    )
