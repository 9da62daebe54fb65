"""Deorders a sequence of actions: causal links, and only the orderings that these require.

Source: Bäckström, Computational aspects of reordering plans, JAIR 9 (1998); Muise, Beck & McIlraith, JAIR 57 (2016).
The result is sound in every order that it leaves open. A link's producer is the earliest action since which its
literal has been true; an action that would undo a link stays on its side of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tailor.executive.planning.forward.strips_task import StripsAction, StripsTask
from tailor.executive.planning.plans.schedule import bits_of


@dataclass(frozen=True, slots=True)
class Support:
    """A causal link between positions of the sequence: -1 is the initial state, its length the goal."""

    producer: int
    literal: int
    consumer: int


@dataclass(frozen=True, slots=True)
class Deordered:
    """Links by consumer, and for each position the mask of the positions that come before it, transitively closed."""

    links: tuple[Support, ...]
    before: tuple[int, ...]

    def pairs(self) -> Iterator[tuple[int, int]]:
        """The pairs (i, j) of positions with i before j, sorted."""
        after: list[list[int]] = [[] for _ in self.before]
        for j, mask in enumerate(self.before):
            for i in bits_of(mask):
                after[i].append(j)
        for i, later in enumerate(after):
            yield from ((i, j) for j in later)

    def levels(self) -> list[int]:
        """The longest chain that ends in each position, counted from 1."""
        levels: list[int] = []
        for mask in self.before:
            levels.append(1 + max([levels[i] for i in bits_of(mask)], default=0))
        return levels


def deordered(sequence: Sequence[StripsAction], strips: StripsTask) -> Deordered:
    """Links and orderings of a sequence that reaches the goal.

    Args:
      sequence: Actions, each applicable in its turn.
      strips: Their task.
    """
    links = tuple(_links(sequence, strips))
    undoing: dict[int, list[int]] = {}
    for position, action in enumerate(sequence):
        for literal in action.made:
            undoing.setdefault(literal ^ 1, []).append(position)
    before = [0] * (len(sequence) + 1)
    for link in links:
        if link.producer >= 0:
            before[link.consumer] |= 1 << link.producer
        for other in undoing.get(link.literal, ()):
            if other > link.consumer:
                before[other] |= 1 << link.consumer
            elif other < link.producer:
                before[link.producer] |= 1 << other
    for position in range(len(sequence)):  # the positions are a topological order
        closed = direct = before[position]
        while direct:
            lowest = direct & -direct
            closed |= before[lowest.bit_length() - 1]
            direct ^= lowest
        before[position] = closed
    return Deordered(links, tuple(before[: len(sequence)]))


def _links(sequence: Sequence[StripsAction], strips: StripsTask) -> Iterator[Support]:
    """A link for each condition, the goal's last."""
    since: dict[int, int] = {}  # the action that last made each literal true
    state = strips.initial
    for consumer, action in enumerate(sequence):
        yield from (Support(since.get(literal, -1), literal, consumer) for literal in action.needs)
        since.update((literal, consumer) for literal in action.made if not state >> literal & 1)
        state = action.after(state)
    yield from (Support(since.get(literal, -1), literal, len(sequence)) for literal in strips.goal)
