"""Arithmetic on orderings of steps: levels, transitive closure, bounds of a schedule."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.plans.portions import Work

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


def scheduling(steps: Sequence[int], orderings: Iterable[Pair]) -> Work[tuple[dict[int, float], tuple[Pair, ...]]]:
    """The levels of the steps and the transitive closure of their orderings, sorted.

    Args:
      steps: In an order that the orderings agree with.
      orderings: Pairs of these steps.
    """
    position = {step: n for n, step in enumerate(steps)}
    after = [0] * len(steps)  # bit masks of positions
    for i, j in orderings:
        after[position[i]] |= 1 << position[j]
    level = [1.0] * len(steps)
    for i in range(len(steps)):
        for j in bits_of(after[i]):
            level[j] = max(level[j], level[i] + 1.0)
        yield
    for i in reversed(range(len(steps))):
        for j in bits_of(after[i]):
            after[i] |= after[j]
        yield
    pairs: list[Pair] = []
    for step in sorted(steps):
        pairs += [(step, later) for later in sorted(steps[j] for j in bits_of(after[position[step]]))]
        yield
    return {step: level[n] for step, n in position.items()}, tuple(pairs)


def bits_of(mask: int) -> list[int]:
    """The positions of the bits of a mask, in order."""
    return [n for n, bit in enumerate(reversed(f"{mask:b}")) if bit == "1"]


def closure(orderings: Iterable[Pair]) -> tuple[Pair, ...]:
    """The transitive closure, sorted."""
    after: dict[int, int] = {}  # bit masks
    for i, j in orderings:
        after[i] = after.get(i, 0) | 1 << j
    for middle in tuple(after):
        beyond = after[middle]
        after.update((i, later | beyond) for i, later in after.items() if later >> middle & 1)
    return tuple((i, j) for i in sorted(after) for j in bits_of(after[i]))


def scheduled_bounds(plan: Plan) -> tuple[tuple[int | None, ...], ...]:
    """Bounds as `Plan.bounds` has them, of a durative plan that was printed without: its times and orderings.

    Each step starts at its time or later and lasts as long as planned. Empty unless the steps are numbered 1, 2, ...
    """
    size = 2 * len(plan.steps) + 1
    if not plan.durative or sorted(step.id for step in plan.steps) != list(range(1, len(plan.steps) + 1)):
        return ()
    rows: list[list[int | None]] = [[0 if a == b else None for b in range(size)] for a in range(size)]
    for step in plan.steps:
        start, end = 2 * step.id - 1, 2 * step.id
        begins, lasts = round(step.start / plan.tick_s), round(step.duration / plan.tick_s)
        rows[start][0], rows[end][0] = -begins, -begins - lasts
        rows[start][end], rows[end][start] = lasts, -lasts
    for i, j in plan.orderings:
        rows[2 * j - 1][2 * i] = 0
    return tuple(map(tuple, rows))
