"""Whether a formula reads facts that another event changes: simultaneous events must not (no moving targets).

Source: Fox & Long, PDDL 2.1, JAIR 20 (2003): neither event changes an atom of the other's conditions, whatever these
conditions evaluate to.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import (
    Action,
    And,
    Atom,
    Condition,
    Equal,
    Formula,
    Not,
    Or,
    Quantified,
    Typed,
)
from tailor.executive.planning.semantics.state import Binding, Objects

Terms = Mapping[str, str | Typed]  # by name: an object, or a variable that stands for all objects of its types


def reads(action: Action, moments: tuple[str, ...], binding: Binding, facts: frozenset[Fact], objects: Objects) -> bool:
    """Whether an action reads one of the facts at some moments, in its conditions or those of its effects.

    Args:
      action: Action schema.
      moments: Moments of the action that one event covers.
      binding: Objects of its parameters.
      facts: Facts that are changed.
      objects: Objects of the problem.
    """
    if _any_reads(action.conditions, moments, binding, facts, objects):
        return True
    return any(
        _any_reads(effect.condition, moments, {**binding, **{v.name: v for v in effect.variables}}, facts, objects)
        for effect in action.effects
        if all(objects.of(variable) for variable in effect.variables)
    )


def _any_reads(
    conditions: Iterable[Condition], moments: tuple[str, ...], terms: Terms, facts: frozenset[Fact], objects: Objects
) -> bool:
    return any(_reads(part.formula, terms, facts, objects) for part in conditions if part.when in moments)


def _reads(formula: Formula, terms: Terms, facts: frozenset[Fact], objects: Objects) -> bool:
    match formula:
        case Atom(predicate, own):
            if any(isinstance(terms.get(term), Typed) for term in own):
                return any(names(formula, terms, fact, objects) for fact in facts)
            return (predicate, *(terms.get(term, term) for term in own)) in facts  # of an effect there may be many
        case Equal():
            return False
        case Not(part):
            return _reads(part, terms, facts, objects)
        case And(parts) | Or(parts):
            possible = _undecided(formula, terms, objects)
            return possible is not None and any(_reads(part, possible, facts, objects) for part in parts)
        case Quantified(_, variables, part):
            inner = {**terms, **{v.name: v for v in variables}}
            return all(objects.of(v) for v in variables) and _reads(part, inner, facts, objects)


def _undecided(formula: And | Or, terms: Terms, objects: Objects) -> Terms | None:
    """The terms without objects for which an equality among its parts decides a formula; None if it always does.

    So does one of a conjunction that fails, and one of a disjunction that holds: no fact is read then. A derived
    predicate with parameters of narrower types has such an equality.
    """
    for part in formula.parts:
        equality = part.part if isinstance(part, Not) else part
        if not isinstance(equality, Equal):
            continue
        narrowed = _equated(equality, terms, objects)
        if isinstance(formula, And) == (equality is part):  # a conjunction with it, or a disjunction with its negation
            if narrowed is None:
                return None
            terms = narrowed
        elif all(isinstance(terms.get(x, x), str) for x in (equality.left, equality.right)) and narrowed is not None:
            return None
    return terms


def _equated(equality: Equal, terms: Terms, objects: Objects) -> Terms | None:
    """The terms with both sides the same object, if one side is an object; None if they cannot be."""
    left, right = (terms.get(side, side) for side in (equality.left, equality.right))
    if isinstance(left, Typed) and isinstance(right, Typed):
        return terms
    if isinstance(left, Typed):
        return {**terms, equality.left: right} if right in objects.of(left) else None
    if isinstance(right, Typed):
        return {**terms, equality.right: left} if left in objects.of(right) else None
    return terms if left == right else None


def names(atom: Atom, terms: Terms, fact: Fact, objects: Objects) -> bool:
    """Whether a fact is the atom for some choice of the variables that stand for several objects."""
    if atom.predicate != fact[0]:
        return False
    chosen: dict[str, str] = {}
    for name, actual in zip(atom.terms, fact[1:], strict=True):
        term = terms.get(name, name)
        if isinstance(term, Typed):
            fits = actual in objects.of(term) and chosen.setdefault(name, actual) == actual
        else:
            fits = term == actual
        if not fits:
            return False
    return True
