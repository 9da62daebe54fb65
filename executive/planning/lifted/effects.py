"""The effects of a schema: under which conditions each one holds, achieves something, and is not undone."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from tailor.executive.planning.ground.ground_action import INSTANT, MOMENTS, Span
from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.ground.grounding import MAX_WAYS
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.lifted.lifter import Lifter, Names
from tailor.executive.planning.pddl.language import Action, When
from tailor.executive.planning.structures.connectives import FALSE, TRUE, conjunction, disjunction

Spanned = tuple[tuple[LiftedFormula, Span], ...]
Pairs = tuple[tuple[str, str], ...]


class Guard(NamedTuple):
    """A condition of a conditional effect, and its opposite."""

    holds: LiftedFormula
    fails: LiftedFormula
    span: Span


class LiftedEffect(NamedTuple):
    """A literal that becomes true at a moment where all guards hold.

    To achieve anything, each pair of `apart` must differ: lest the action demands the effect already (the no-op rule).
    """

    literal: LiftedLiteral
    moment: int
    guards: tuple[Guard, ...] = ()
    apart: Pairs = ()


def span_of(when: When, durative: bool) -> Span:
    """The moments of a condition or effect."""
    return MOMENTS[when] if durative else INSTANT


def lifted_effects(
    action: Action, names: Names, conditions: Spanned, lifter: Lifter, durative: bool
) -> tuple[LiftedEffect, ...]:
    """The effects of an action, in order, without those that achieve nothing; "forall" is spelled out.

    Args:
      action: The action.
      names: Its parameters' names in the schema.
      conditions: The schema's own.
      lowering: The schema's.
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
                    lifter.lowered(c.formula, inner),
                    lifter.lowered(c.formula, inner, False),
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
            useful += [made._replace(guards=guards, apart=apart) for guards in _unless_added(made, written)]
    return tuple(effect for effect in useful if all(guard.holds != FALSE for guard in effect.guards))


def _no_op(effect: LiftedEffect, conditions: Spanned) -> Pairs | None:
    """The pairs that must differ lest the effect be demanded already; None when it always is."""
    literal = effect.literal
    apart: Pairs = ()
    for condition, span in conditions:
        if not isinstance(condition, LiftedLiteral) or span[1] != effect.moment:
            continue
        if condition.predicate == literal.predicate and condition.positive == literal.positive:
            differing = _differing(literal, condition)
            if not differing:
                return None
            apart += differing if len(differing) == 1 else ()  # with more, no single pair need differ
    return apart


def _unless_added(effect: LiftedEffect, effects: Iterable[LiftedEffect]) -> list[tuple[Guard, ...]]:
    """The guards with which an effect lasts; for a delete effect several ways to escape the adds that would win.

    Where an add effect looks at several moments, it is enough that it fails at one: each is a way of its own.
    """
    ways = [effect.guards]
    if effect.literal.positive:
        return ways
    for other in effects:
        if other.literal[0] == effect.literal[0] and other.literal.positive and other.moment == effect.moment:
            sparing = _sparing_guards(other, effect.literal)
            if all(guard.holds != TRUE for guard in sparing):
                ways = [(*way, guard) for way in ways for guard in sparing]
                if len(ways) > MAX_WAYS:
                    raise TooMuchToGround(f"more than {MAX_WAYS} ways in which an action's additions spare a deletion")
    return ways


def _sparing_guards(winner: LiftedEffect, literal: LiftedLiteral) -> list[Guard]:
    """How an add effect leaves a delete of `literal` alone: it adds another fact, or its guards of one span fail."""
    pairs = _differing(literal, winner.literal)
    apart: LiftedFormula = disjunction(equality(a, b, False) for a, b in pairs)
    same: LiftedFormula = conjunction(equality(a, b, True) for a, b in pairs)
    spans: dict[Span, list[Guard]] = {} if winner.guards else {(winner.moment, winner.moment): []}
    for guard in winner.guards:
        spans.setdefault(guard.span, []).append(guard)
    return [
        Guard(disjunction([apart, *(g.fails for g in own)]), conjunction([same, *(g.holds for g in own)]), span)
        for span, own in spans.items()
    ]


def _differing(a: LiftedLiteral, b: LiftedLiteral) -> Pairs:
    """The pairs of terms that are not the same name; schema terms are plain names."""
    return tuple((str(x), str(y)) for x, y in zip(a.terms, b.terms, strict=True) if x != y)
