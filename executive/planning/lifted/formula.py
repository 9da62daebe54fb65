"""Lifted conditions: literals and (in)equalities over terms, joined by "all of" and "any of", in negation normal form.

In a schema variables are plain names; in a plan each is tagged with its step (`of_step`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from executive.planning.lifted.bindings import Term


class LiftedLiteral(NamedTuple):
    """A predicate over terms, or its negation."""

    predicate: str
    terms: tuple[Term, ...]
    positive: bool = True

    def of_step(self, step: int) -> LiftedLiteral:
        """The literal with the variables of one step."""
        return self._replace(terms=tuple([tagged(term, step) for term in self.terms]))


class Equality(NamedTuple):
    """Two terms are the same, or (`same` false) they differ."""

    left: Term
    right: Term
    same: bool = True

    def of_step(self, step: int) -> Equality:
        """The equality with the variables of one step."""
        return Equality(tagged(self.left, step), tagged(self.right, step), self.same)


@dataclass(frozen=True, slots=True)
class AllOf:
    """A conjunction."""

    parts: tuple[LiftedFormula, ...]

    def of_step(self, step: int) -> AllOf:
        """The conjunction with the variables of one step."""
        return AllOf(tuple(part.of_step(step) for part in self.parts))


@dataclass(frozen=True, slots=True)
class AnyOf:
    """A disjunction."""

    parts: tuple[LiftedFormula, ...]

    def of_step(self, step: int) -> AnyOf:
        """The disjunction with the variables of one step."""
        return AnyOf(tuple(part.of_step(step) for part in self.parts))


LiftedFormula = LiftedLiteral | Equality | AllOf | AnyOf
TRUE = AllOf(())
FALSE = AnyOf(())


def tagged(term: Term, step: int) -> Term:
    """A schema's term as one of a step: objects stay as they are."""
    return (term, step) if isinstance(term, str) and term[0] == "?" else term


def conjunction(formulas: Iterable[LiftedFormula]) -> LiftedFormula:
    """All of them, flattened, in order; FALSE when one is false."""
    parts: list[LiftedFormula] = []
    for formula in formulas:
        if formula == FALSE:
            return FALSE
        parts += conjuncts(formula)
    return parts[0] if len(parts) == 1 else AllOf(tuple(parts))


def disjunction(formulas: Iterable[LiftedFormula]) -> LiftedFormula:
    """Any of them, flattened, each once, in order; TRUE when one is true."""
    parts: dict[LiftedFormula, None] = {}
    for formula in formulas:
        if formula == TRUE:
            return TRUE
        parts.update(dict.fromkeys(formula.parts if isinstance(formula, AnyOf) else (formula,)))
    return next(iter(parts)) if len(parts) == 1 else AnyOf(tuple(parts))


def conjuncts(formula: LiftedFormula) -> tuple[LiftedFormula, ...]:
    """The formula as a list of parts that must all hold."""
    return formula.parts if isinstance(formula, AllOf) else (formula,)


def equality(left: Term, right: Term, same: bool) -> LiftedFormula:
    """The equality of two terms of a schema, decided where it can be."""
    if left == right:
        return TRUE if same else FALSE
    if str(left)[0] != "?" and str(right)[0] != "?":  # two objects
        return FALSE if same else TRUE
    return Equality(left, right, same)
