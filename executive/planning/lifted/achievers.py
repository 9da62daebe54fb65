"""Achievers of a lifted open condition: schemata, steps of the plan, bindings to the initial state."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.lifted.bindings import Bindings, Term
from tailor.executive.planning.lifted.effects import LiftedEffect
from tailor.executive.planning.lifted.formula import LiftedLiteral
from tailor.executive.planning.lifted.lifted_plan import LiftedCondition, LiftedPlan, effects_of, unifying
from tailor.executive.planning.lifted.schema import Schema
from tailor.executive.planning.lifted.task import Achiever, LiftedTask, PlacedEffect

MAX_INSTANCES = 2_500  # of a negative condition with free variables: a tenth of a second


def new_achievers(task: LiftedTask, bindings: Bindings, literal: LiftedLiteral) -> Iterator[Achiever]:
    """Schemata with an effect of the literal's predicate and sign, and with compatible fixed parameters."""
    for schema, effect in task.achievers.get((literal.predicate, literal.positive), ()):
        if not schema.fixed or _matches(schema, effect, bindings, literal):
            yield schema, effect


def _matches(schema: Schema, effect: LiftedEffect, bindings: Bindings, literal: LiftedLiteral) -> bool:
    fixed = (schema.fixed.get(str(term)) for term in effect.literal.terms)
    return all(name is None or bindings.may_equal(term, name) for name, term in zip(fixed, literal.terms, strict=True))


def old_achievers(
    task: LiftedTask, plan: LiftedPlan, flaw: LiftedCondition, literal: LiftedLiteral
) -> Iterator[PlacedEffect]:
    """Effects in the plan that unify with the condition's literal and may come before it, newest step first."""
    late = plan.orderings.late[flaw.first]
    if flaw.first != flaw.last:
        late ^= 1 << flaw.first  # the action's own start may achieve its condition over all
    for placed in effects_of(task, plan):
        if not late >> placed.node & 1 and unifying(literal, placed.literal, plan.bindings):
            yield placed


def initial_achievers(task: LiftedTask, bindings: Bindings, literal: LiftedLiteral) -> Iterator[Bindings]:
    """The bindings with which a literal holds in the initial state; a negative one by closed world.

    Raises:
      TooMuchToGround: A negative literal has more than MAX_INSTANCES instances.
    """
    facts = task.initial.get(literal.predicate, ())
    if literal.positive:
        for fact in facts:
            bound = bindings.unified(zip(literal.terms, fact[1:], strict=True))
            if bound is not None:
                yield bound
        return
    present = set(facts)
    objects = [_objects(task, bindings, term) for term in literal.terms]
    if math.prod(len(names) for names in objects) > MAX_INSTANCES:
        raise TooMuchToGround(f"'not {literal.predicate}' has more than {MAX_INSTANCES} instances")
    for names in itertools.product(*objects):
        if (literal.predicate, *names) not in present:
            bound = bindings.unified(zip(literal.terms, names, strict=True))
            if bound is not None:
                yield bound


def _objects(task: LiftedTask, bindings: Bindings, term: Term) -> tuple[str, ...]:
    value = bindings.value(term)
    if value is not None:
        return (value,)
    return tuple(name for name in task.world.objects["object"] if bindings.may_equal(term, name))
