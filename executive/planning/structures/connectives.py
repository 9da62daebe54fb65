"""Conjunctions and disjunctions over parts of any kind: what ground and lifted conditions are built with."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Generic, TypeAlias, TypeVar

L = TypeVar("L")  # leaves: ground literals, or lifted literals and equalities


@dataclass(frozen=True, slots=True)
class Every(Generic[L]):
    """All parts hold; no parts: true."""

    parts: tuple[L | Every[L] | Some[L], ...]


@dataclass(frozen=True, slots=True)
class Some(Generic[L]):
    """Some part holds; no parts: false."""

    parts: tuple[L | Every[L] | Some[L], ...]


Joined: TypeAlias = L | Every[L] | Some[L]
TRUE: Every[Any] = Every(())
FALSE: Some[Any] = Some(())


def conjunction(conditions: Iterable[Joined[L]]) -> Joined[L]:
    """All of them, flattened, in order, as often as they stand there; FALSE when one is false."""
    parts: list[Joined[L]] = []
    for condition in conditions:
        if condition == FALSE:
            return FALSE
        parts += condition.parts if isinstance(condition, Every) else (condition,)
    return parts[0] if len(parts) == 1 else Every(tuple(parts))


def disjunction(conditions: Iterable[Joined[L]]) -> Joined[L]:
    """Any of them, flattened, each once, in order; TRUE when one is true."""
    parts: dict[Joined[L], None] = {}
    for condition in conditions:
        if condition == TRUE:
            return TRUE
        parts.update(dict.fromkeys(condition.parts if isinstance(condition, Some) else (condition,)))
    return next(iter(parts)) if len(parts) == 1 else Some(tuple(parts))


def conjuncts(condition: Joined[L]) -> tuple[Joined[L], ...]:
    """The condition as a list of parts that must all hold."""
    return condition.parts if isinstance(condition, Every) else (condition,)
