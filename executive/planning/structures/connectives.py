"""Conjunctions and disjunctions over leaves of any type; ground and lifted conditions are built from them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Generic, TypeAlias, TypeVar

L = TypeVar("L")  # leaves: ground literals, or lifted literals and equalities


@dataclass(frozen=True, slots=True)
class Conjunction(Generic[L]):
    """All parts hold; no parts: true."""

    parts: tuple[L | Conjunction[L] | Disjunction[L], ...]


@dataclass(frozen=True, slots=True)
class Disjunction(Generic[L]):
    """Some part holds; no parts: false."""

    parts: tuple[L | Conjunction[L] | Disjunction[L], ...]


AndOrTree: TypeAlias = L | Conjunction[L] | Disjunction[L]
TRUE: Conjunction[Any] = Conjunction(())
FALSE: Disjunction[Any] = Disjunction(())


def conjunction(conditions: Iterable[AndOrTree[L]]) -> AndOrTree[L]:
    """The conjunction, flattened, in order, duplicates kept; FALSE if a part is false."""
    parts: list[AndOrTree[L]] = []
    for condition in conditions:
        if condition == FALSE:
            return FALSE
        parts += condition.parts if isinstance(condition, Conjunction) else (condition,)
    return parts[0] if len(parts) == 1 else Conjunction(tuple(parts))


def disjunction(conditions: Iterable[AndOrTree[L]]) -> AndOrTree[L]:
    """The disjunction, flattened, in order, without duplicates; TRUE if a part is true."""
    parts: dict[AndOrTree[L], None] = {}
    for condition in conditions:
        if condition == TRUE:
            return TRUE
        parts.update(dict.fromkeys(condition.parts if isinstance(condition, Disjunction) else (condition,)))
    return next(iter(parts)) if len(parts) == 1 else Disjunction(tuple(parts))


def conjuncts(condition: AndOrTree[L]) -> tuple[AndOrTree[L], ...]:
    """The parts of a conjunction; a tuple of one for any other condition."""
    return condition.parts if isinstance(condition, Conjunction) else (condition,)
