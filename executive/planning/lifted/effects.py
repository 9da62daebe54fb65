"""Effects of a schema, with the conditions under which each happens, is not a no-op and is not undone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeVar

from tailor.executive.planning.ground.ground_action import Span, span_of
from tailor.executive.planning.ground.instances import excluding
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.lifted.lifter import PORTION_STEPS, Lifter, Names, Paced
from tailor.executive.planning.pddl.language import Action
from tailor.executive.planning.structures.connectives import FALSE, TRUE, conjunction, disjunction

Spanned = tuple[tuple[LiftedFormula, Span], ...]
Pairs = tuple[tuple[str, str], ...]
T = TypeVar("T")
COMPARED_PER_STEP = 8  # literals compared per step of the limit


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


def lifted_effects(
    action: Action, names: Names, conditions: Spanned, lifter: Lifter, durative: bool
) -> Paced[tuple[LiftedEffect, ...]]:
    """The effects of an action, in order, without no-ops; "forall" is expanded over the objects.

    Yields after each portion.

    Args:
      action: Action schema as read.
      names: Names of its parameters in the lifted schema.
      conditions: Conditions of the lifted schema.
      lifter: Converter of this schema's formulas.
      durative: Whether actions of the domain take time.
    """
    written = yield from _written(action, names, lifter, durative)
    met = _grouped((part, span[1], part) for part, span in conditions if isinstance(part, LiftedLiteral))
    added = _grouped((effect.literal, effect.moment, effect) for effect in written if effect.literal.positive)
    useful: list[LiftedEffect] = []
    for number, made in enumerate(written, 1):
        alike = met.get((made.literal.predicate, made.literal.positive, made.moment), [])
        lifter.spend(len(alike) // COMPARED_PER_STEP)
        apart = _no_op(made, alike)
        if apart is not None:
            additions = [] if made.literal.positive else added.get((made.literal.predicate, True, made.moment), [])
            useful += [made._replace(guards=guards, apart=apart) for guards in _unless(additions, made, lifter)]
        if lifter.is_due() or number % PORTION_STEPS == 0:
            yield
    return tuple(effect for effect in useful if all(guard.holds != FALSE for guard in effect.guards))


def _written(action: Action, names: Names, lifter: Lifter, durative: bool) -> Paced[dict[LiftedEffect, None]]:
    """The effects as they are stated, each once, for all objects."""
    written: dict[LiftedEffect, None] = {}
    for effect in action.effects:
        for inner in lifter.choices(effect.variables, names):
            literal = LiftedLiteral(
                effect.atom.predicate, tuple(inner.get(t, t) for t in effect.atom.terms), effect.positive
            )
            guards: list[Guard] = []
            for c in effect.condition:
                holds = yield from lifter.lift(c.formula, inner)
                fails = yield from lifter.lift(c.formula, inner, False)
                guards.append(Guard(holds, fails, span_of(c.when, durative)))
            moment = span_of(effect.when, durative)[0]
            written.setdefault(LiftedEffect(literal, moment, tuple(g for g in guards if g.holds != TRUE)))
            if lifter.is_due():
                yield
    return written


def _no_op(effect: LiftedEffect, conditions: Sequence[LiftedLiteral]) -> Pairs | None:
    """The pairs that must differ for the effect not to be a no-op; None if it always is one.

    The conditions are those of its predicate and sign that hold up to its moment.
    """
    apart: Pairs = ()
    for condition in conditions:
        differing = _differing(effect.literal, condition)
        if not differing:
            return None
        apart += differing if len(differing) == 1 else ()  # with several pairs, none in particular must differ
    return apart


def _unless(additions: Iterable[LiftedEffect], effect: LiftedEffect, lifter: Lifter) -> list[tuple[Guard, ...]]:
    """Alternative guards of an effect; those of a delete effect exclude the add effects of that predicate and moment.

    An add effect with guards at several moments fails if those of one moment fail: each gives one alternative.
    """
    ways: list[list[tuple[Guard, ...]]] = []
    for other in additions:
        lifter.spend()
        sparing = _sparing_guards(other, effect.literal)
        if all(guard.holds != TRUE for guard in sparing):
            ways.append([(guard,) for guard in sparing])
    return excluding(effect.guards, ways)


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


def _grouped(items: Iterable[tuple[LiftedLiteral, int, T]]) -> dict[tuple[str, bool, int], list[T]]:
    """Things by predicate and sign of a literal, and by a moment: thousands are not compared with all others."""
    groups: dict[tuple[str, bool, int], list[T]] = {}
    for literal, moment, item in items:
        groups.setdefault((literal.predicate, literal.positive, moment), []).append(item)
    return groups
