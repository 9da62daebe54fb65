"""Conjunctions and disjunctions over parts of any kind: what ground and lifted conditions are built with."""

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
    """All of them, flattened, in order, as often as they stand there; FALSE when one is false."""
    parts: list[AndOrTree[L]] = []
    for condition in conditions:
        if condition == FALSE:
            return FALSE
        parts += condition.parts if isinstance(condition, Conjunction) else (condition,)
    return parts[0] if len(parts) == 1 else Conjunction(tuple(parts))


def disjunction(conditions: Iterable[AndOrTree[L]]) -> AndOrTree[L]:
    """Any of them, flattened, each once, in order; TRUE when one is true."""
    parts: dict[AndOrTree[L], None] = {}
    for condition in conditions:
        if condition == TRUE:
            return TRUE
        parts.update(dict.fromkeys(condition.parts if isinstance(condition, Disjunction) else (condition,)))
    return next(iter(parts)) if len(parts) == 1 else Disjunction(tuple(parts))


def conjuncts(condition: AndOrTree[L]) -> tuple[AndOrTree[L], ...]:
    """The condition as a list of parts that must all hold."""
    return condition.parts if isinstance(condition, Conjunction) else (condition,)
