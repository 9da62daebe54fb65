"""Arithmetic on orderings of steps: levels and transitive closure."""

from __future__ import annotations

from collections.abc import Iterable

Pair = tuple[int, int]


def levels(steps: Iterable[int], orderings: Iterable[Pair]) -> dict[int, float] | None:
    """The longest chain that ends in each step, counted from 1; None if the orderings have a cycle."""
    before: dict[int, set[int]] = {step: set() for step in steps}
    for i, j in orderings:
        if i in before and j in before:
            before[j].add(i)
    level: dict[int, float] = {}
    while len(level) < len(before):
        ready = [step for step, earlier in before.items() if step not in level and earlier <= level.keys()]
        if not ready:
            return None
        for step in ready:
            level[step] = 1.0 + max((level[earlier] for earlier in before[step]), default=0.0)
    return level


def closure(orderings: Iterable[Pair]) -> tuple[Pair, ...]:
    """The transitive closure, sorted."""
    after: dict[int, set[int]] = {}
    for i, j in orderings:
        after.setdefault(i, set()).add(j)
    changed = True
    while changed:
        changed = False
        for later in after.values():
            size = len(later)
            later.update(*[after.get(j, set()) for j in list(later)])
            changed = changed or len(later) > size
    return tuple(sorted((i, j) for i, later in after.items() for j in later))
