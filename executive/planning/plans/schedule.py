"""Arithmetic on orderings of steps: levels and transitive closure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

Pair = tuple[int, int]


def levels(steps: Iterable[int], orderings: Iterable[Pair]) -> dict[int, float] | None:
    """The longest chain that ends in each step, counted from 1; None if the orderings have a cycle."""
    after: dict[int, set[int]] = {step: set() for step in steps}
    for i, j in orderings:
        if i in after and j in after:
            after[i].add(j)
    missing = Counter(j for later in after.values() for j in later)
    level = {step: 1.0 for step in after if not missing[step]}
    ready = list(level)
    for i in ready:  # grows meanwhile
        for j in after[i]:
            level[j] = max(level.get(j, 1.0), level[i] + 1.0)
            missing[j] -= 1
            if not missing[j]:
                ready.append(j)
    return level if len(ready) == len(after) else None


def closure(orderings: Iterable[Pair]) -> tuple[Pair, ...]:
    """The transitive closure, sorted."""
    after: dict[int, int] = {}  # bit masks
    for i, j in orderings:
        after[i] = after.get(i, 0) | 1 << j
    for middle in tuple(after):
        beyond = after[middle]
        after.update((i, later | beyond) for i, later in after.items() if later >> middle & 1)
    return tuple((i, j) for i in sorted(after) for j in range(after[i].bit_length()) if after[i] >> j & 1)
