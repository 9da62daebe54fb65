"""Orderings of plan nodes: the interface, and the transitive closure of "before" with one int per node.

A node is a moment of a step: its only one, or its start and its end if actions take time. `late[n]` is the bit mask
of the nodes that cannot come before node n: n itself and all that must come after it. Every ordering test is one AND
with such a mask; the temporal network keeps the same masks.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Protocol

INITIAL = 0  # node of the initial state: before all others
GOAL = 1  # node of the goal: after all others
GOAL_STEP = -1  # step number of the goal; the initial state is step 0
FIRST = 2  # node of the first step, or of the first timed literal


class HasDuration(Protocol):
    """An action with a duration in ticks; `longest` is None without an upper limit."""

    @property
    def shortest(self) -> int:
        """The shortest duration."""
        ...

    @property
    def longest(self) -> int | None:
        """The longest duration."""
        ...


class Orderings(Protocol):
    """Immutable constraints on the order of nodes."""

    @property
    def late(self) -> tuple[int, ...]:
        """By node, the mask of the nodes that cannot come before it."""
        ...

    @property
    def entries(self) -> int:
        """Number of stored entries: nearly all of the memory that a plan does not share with its parent."""
        ...

    def with_step(self, action: HasDuration, moment: int, before: int) -> Orderings | None:
        """The orderings with the nodes of one more step, after the initial state and before the goal.

        Args:
          action: Action of the step.
          moment: 0 for the step's start, 1 for its end.
          before: Node that this moment comes before.

        Returns:
          None if the constraints become inconsistent.
        """
        ...

    def ordered(self, a: int, b: int) -> Orderings | None:
        """The orderings with node a before node b; None if that is inconsistent."""
        ...

    def not_before(self, node: int) -> int:
        """The mask of the nodes that cannot come before a node at all; those of `late` cannot by a tick or more."""
        ...

    def earliest(self) -> tuple[float, ...]:
        """The earliest time of each node, the goal's is the makespan: levels without durations, else ticks."""
        ...


def nodes_after(orderings: Orderings, first: int, last: int) -> int:
    """The mask of the nodes that cannot come before the end of a condition, which holds from `first` to `last`.

    Of a condition at one node those that cannot come a tick before: its schedule keeps the others a tick apart. A
    condition over all is to hold up to the very end.
    """
    return orderings.late[last] if first == last else orderings.not_before(last)


class Closure(NamedTuple):
    """Orderings of nodes that take no time."""

    late: tuple[int, ...] = (0b11, 0b10)

    @property
    def entries(self) -> int:
        """See `Orderings`."""
        return len(self.late)

    def with_step(self, action: HasDuration, moment: int, before: int) -> Closure:
        """See `Orderings`; the step has one node, and only the initial state comes before it."""
        late = self.late
        bit = 1 << len(late)
        return tuple.__new__(Closure, ((late[0] | bit, *late[1:], bit | late[before]),))

    def ordered(self, a: int, b: int) -> Closure | None:
        """See `Orderings`."""
        late = self.late
        after = late[b]
        bit = 1 << a
        if after & bit:
            return None
        if late[a] >> b & 1:
            return self
        return tuple.__new__(Closure, (tuple([mask | after if mask & bit else mask for mask in late]),))

    def not_before(self, node: int) -> int:
        """See `Orderings`."""
        return self.late[node]

    def earliest(self) -> tuple[float, ...]:
        """See `Orderings`: the longest chain of steps that ends in each node."""
        levels = self.levels({})
        return tuple(levels[node] for node in range(len(self.late)))

    def levels(self, least: Mapping[int, float]) -> dict[int, float]:
        """As `earliest`, each node raised to the level that is given for it."""
        levels: dict[int, float] = {}
        for node in sorted(range(len(self.late)), key=lambda n: -self.late[n].bit_count()):
            before = [level for other, level in levels.items() if self.late[other] >> node & 1]
            levels[node] = max([least.get(node, 0), *before]) + (node not in (INITIAL, GOAL))
        return levels
