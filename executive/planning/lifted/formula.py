"""Lifted conditions: and/or trees of literals and (in)equalities over terms, in negation normal form.

Variables are plain names in a schema; in a plan each is tagged with its step (`of_step`).
"""

from __future__ import annotations

from typing import NamedTuple

from tailor.executive.planning.lifted.bindings import Term
from tailor.executive.planning.structures.connectives import FALSE, TRUE, Conjunction, Disjunction


class LiftedLiteral(NamedTuple):
    """A predicate over terms, or its negation."""

    predicate: str
    terms: tuple[Term, ...]
    positive: bool = True

    def of_step(self, step: int) -> LiftedLiteral:
        """The literal with the variables of one step."""
        return self._replace(terms=tuple([tagged(term, step) for term in self.terms]))


class Equality(NamedTuple):
    """Two terms are equal or, with `same` false, different."""

    left: Term
    right: Term
    same: bool = True

    def of_step(self, step: int) -> Equality:
        """The equality with the variables of one step."""
        return Equality(tagged(self.left, step), tagged(self.right, step), self.same)


LiftedLeaf = LiftedLiteral | Equality
LiftedDisjunction = Disjunction[LiftedLeaf]
LiftedFormula = LiftedLeaf | Conjunction[LiftedLeaf] | LiftedDisjunction


def tagged(term: Term, step: int) -> Term:
    """A term of a schema as a term of one step; objects are unchanged."""
    return (term, step) if isinstance(term, str) and term[0] == "?" else term


def of_step(formula: LiftedFormula, step: int) -> LiftedFormula:
    """A formula of a schema with the variables of one step."""
    match formula:
        case Conjunction(parts):
            return Conjunction(tuple(of_step(part, step) for part in parts))
        case Disjunction(parts):
            return Disjunction(tuple(of_step(part, step) for part in parts))
        case literal:
            return literal.of_step(step)


def equality(left: Term, right: Term, same: bool) -> LiftedFormula:
    """The equality of two terms of a schema, simplified to TRUE or FALSE if possible."""
    if left == right:
        return TRUE if same else FALSE
    if str(left)[0] != "?" and str(right)[0] != "?":  # two objects
        return FALSE if same else TRUE
    return Equality(left, right, same)
