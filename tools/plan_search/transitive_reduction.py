"""The orderings of a plan from which all others follow."""

from __future__ import annotations

from collections.abc import Iterable

Ordering = tuple[int, int]


def transitive_reduction(closed: Iterable[Ordering]) -> list[Ordering]:
    """The orderings of a transitive closure that no two others imply; sorted."""
    orderings = set(closed)
    after: dict[int, set[int]] = {}
    for i, j in orderings:
        after.setdefault(i, set()).add(j)
    implied = {i: set().union(*(after.get(k, ()) for k in later)) for i, later in after.items()}
    return sorted((i, j) for i, j in orderings if j not in implied[i])
