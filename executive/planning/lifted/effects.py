"""Effects of a schema, with the conditions under which each happens, is not a no-op and is not undone."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from tailor.executive.planning.ground.ground_action import INSTANT, MOMENTS, Span
from tailor.executive.planning.ground.instances import excluding
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.lifted.lifter import Lifter, Names
from tailor.executive.planning.pddl.language import Action, When
from tailor.executive.planning.structures.connectives import FALSE, TRUE, conjunction, disjunction

Spanned = tuple[tuple[LiftedFormula, Span], ...]
Pairs = tuple[tuple[str, str], ...]


class Guard(NamedTuple):
    """A condition of a conditional effect, and its negation."""

    holds: LiftedFormula
    fails: LiftedFormula
    span: Span


class LiftedEffect(NamedTuple):
    """A literal that becomes true at a moment if all guards hold.

    The terms of each pair in `apart` must differ: otherwise a condition implies the effect (the no-op rule).
    """

    literal: LiftedLiteral
    moment: int
    guards: tuple[Guard, ...] = ()
    apart: Pairs = ()


def span_of(when: When, durative: bool) -> Span:
    """First and last moment of a condition or effect."""
    return MOMENTS[when] if durative else INSTANT


def lifted_effects(
    action: Action, names: Names, conditions: Spanned, lifter: Lifter, durative: bool
) -> tuple[LiftedEffect, ...]:
    """The effects of an action, in order, without no-ops; "forall" is expanded over the objects.

    Args:
      action: Action schema as read.
      names: Names of its parameters in the lifted schema.
      conditions: Conditions of the lifted schema.
      lifter: Converter of this schema's formulas.
      durative: Whether actions of the domain take time.
    """
    written: dict[LiftedEffect, None] = {}
    for effect in action.effects:
        for inner in lifter.choices(effect.variables, names):
            literal = LiftedLiteral(
                effect.atom.predicate, tuple(inner.get(t, t) for t in effect.atom.terms), effect.positive
            )
            guards = tuple(
                Guard(
                    lifter.lift(c.formula, inner),
                    lifter.lift(c.formula, inner, False),
                    span_of(c.when, durative),
                )
                for c in effect.condition
            )
            moment = span_of(effect.when, durative)[0]
            written.setdefault(LiftedEffect(literal, moment, tuple(g for g in guards if g.holds != TRUE)))
    useful = []
    for made in written:
        apart = _no_op(made, conditions)
        if apart is not None:
            useful += [made._replace(guards=guards, apart=apart) for guards in _unless_added(made, written, lifter)]
    return tuple(effect for effect in useful if all(guard.holds != FALSE for guard in effect.guards))


def _no_op(effect: LiftedEffect, conditions: Spanned) -> Pairs | None:
    """The pairs that must differ for the effect not to be a no-op; None if it always is one."""
    literal = effect.literal
    apart: Pairs = ()
    for condition, span in conditions:
        if not isinstance(condition, LiftedLiteral) or span[1] != effect.moment:
            continue
        if condition.predicate == literal.predicate and condition.positive == literal.positive:
            differing = _differing(literal, condition)
            if not differing:
                return None
            apart += differing if len(differing) == 1 else ()  # with several pairs, none in particular must differ
    return apart


def _unless_added(effect: LiftedEffect, effects: Iterable[LiftedEffect], lifter: Lifter) -> list[tuple[Guard, ...]]:
    """Alternative guards of an effect; those of a delete effect exclude the add effects of the same moment.

    An add effect with guards at several moments fails if those of one moment fail: each gives one alternative.
    """
    additions: list[list[tuple[Guard, ...]]] = []
    for other in effects if not effect.literal.positive else ():
        if other.literal[0] == effect.literal[0] and other.literal.positive and other.moment == effect.moment:
            lifter.spend()
            sparing = _sparing_guards(other, effect.literal)
            if all(guard.holds != TRUE for guard in sparing):
                additions.append([(guard,) for guard in sparing])
    return excluding(effect.guards, additions)


def _sparing_guards(addition: LiftedEffect, literal: LiftedLiteral) -> list[Guard]:
    """Guards under which an add effect spares a delete of `literal`: other terms, or its guards of one span fail."""
    pairs = _differing(literal, addition.literal)
    apart: LiftedFormula = disjunction(equality(a, b, False) for a, b in pairs)
    same: LiftedFormula = conjunction(equality(a, b, True) for a, b in pairs)
    spans: dict[Span, list[Guard]] = {} if addition.guards else {(addition.moment, addition.moment): []}
    for guard in addition.guards:
        spans.setdefault(guard.span, []).append(guard)
    return [
        Guard(disjunction([apart, *(g.fails for g in own)]), conjunction([same, *(g.holds for g in own)]), span)
        for span, own in spans.items()
    ]


def _differing(a: LiftedLiteral, b: LiftedLiteral) -> Pairs:
    """The pairs of terms with different names; schema terms are plain names."""
    return tuple((str(x), str(y)) for x, y in zip(a.terms, b.terms, strict=True) if x != y)
