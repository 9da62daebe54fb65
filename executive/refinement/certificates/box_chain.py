"""A chain of subgoals whose parameters are cut into boxes: what each pair of neighbouring boxes costs at least.

Dynamic programming over the boxes gives the least of all chains, which no choice of the parameters goes below.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.boxes import NOWHERE, Boxes, joined
from tailor.executive.refinement.solvers.chain import forward_costs, through_costs, traced

Places = NDArray[np.intp]


class PairBound(Protocol):
    """What a pair of boxes costs at least."""

    @property
    def effort(self) -> int:
        """Elementary comparisons for one pair, roughly."""
        ...

    def least(self, before: Boxes, own: Boxes) -> Array:
        """Seconds, shape (len(before), len(own))."""
        ...


@dataclass(frozen=True, slots=True)
class Costs:
    """The least costs of chains: from the start up to each box, and of whole chains through it, by subgoal."""

    forward: list[Array]
    through: list[Array]

    def rest(self, index: int) -> Array:
        """From each box of a subgoal to the end; inf where no chain leads."""
        through, forward = self.through[index], self.forward[index]
        return np.where(np.isfinite(through), through - np.where(np.isfinite(forward), forward, 0.0), np.inf)


class BoxChain:
    """Boxes and pair costs of s subgoals; the boxes of one subgoal are replaced at a time.

    Args:
      bounds: What a pair of boxes costs at least, action by action.
      boxes: The first boxes of each subgoal.
      effort: Elementary comparisons in one step, roughly.
      pieces: That the boxes chosen are cut into at a time, at least.
    """

    def __init__(self, bounds: Sequence[PairBound], boxes: Sequence[Boxes], effort: int, pieces: int) -> None:
        self.boxes = list(boxes)
        self._pieces = pieces
        self._bounds = bounds
        self._effort = effort
        self._tables = [np.full((len(a), len(b)), -np.inf) for a, b in zip([NOWHERE, *boxes], boxes, strict=False)]

    @property
    def steps(self) -> float:
        """How many steps it takes to begin, roughly."""
        efforts = (bound.effort * table.size for bound, table in zip(self._bounds, self._tables, strict=True))
        return sum(efforts) / self._effort

    def begin(self) -> Iterator[None]:
        """Bound all pairs, in steps."""
        for index, table in enumerate(self._tables):
            every = np.arange(table.shape[0]), np.arange(table.shape[1])
            yield from self._bound(index, table, *every)

    def costs(self) -> Costs:
        """What chains cost at least, by the bounds so far."""
        forward = forward_costs(self._tables)
        return Costs(forward, through_costs(self._tables, forward))

    def cheapest(self, costs: Costs) -> list[int]:
        """The box that the cheapest chain takes at each subgoal."""
        return traced(self._tables, costs.forward)

    def cut(
        self, index: int, kept: Places, chosen: Places, weight: Array, costs: Costs, limit: float
    ) -> Iterator[None]:
        """Cut the chosen boxes of a subgoal and forget all but them and the kept ones, in steps.

        Pieces inherit their box's bounds; those on chains that cost less than `limit` are bounded anew.
        """
        children, parents = self.boxes[index].part(chosen), chosen
        while len(parents) < self._pieces:
            children, parents = children.halves(weight), np.tile(parents, 2)
        parents = np.concatenate([kept, parents])
        new = np.arange(len(kept), len(parents))
        before = costs.forward[index - 1] if index else np.zeros(1)
        last = index + 1 == len(self.boxes)
        after = np.zeros(1) if last else costs.rest(index + 1)
        left = self._tables[index]
        near = (before[:, None] + left[:, chosen] + costs.rest(index)[chosen] < limit).any(axis=1)
        self.boxes[index] = joined(self.boxes[index].part(kept), children)
        self._tables[index] = left[:, parents]
        if not last:
            right = self._tables[index + 1]
            far = (costs.forward[index][chosen, None] + right[chosen] + after < limit).any(axis=0)
            self._tables[index + 1] = right[parents]
        yield from self._bound(index, self._tables[index], np.flatnonzero(near), new)
        if not last:
            yield from self._bound(index + 1, self._tables[index + 1], new, np.flatnonzero(far))

    def _bound(self, index: int, table: Array, before: Places, own: Places) -> Iterator[None]:
        """Raise some of a table's entries to what is proven for their boxes, a few at a time."""
        first = self.boxes[index - 1] if index else NOWHERE
        pairs = max(1, self._effort // self._bounds[index].effort)
        high = max(1, min(len(before), pairs))
        wide = max(1, pairs // high)
        for i, j in product(range(0, len(before), high), range(0, len(own), wide)):
            here, there = before[i : i + high], own[j : j + wide]
            said = self._bounds[index].least(first.part(here), self.boxes[index].part(there))
            at = np.ix_(here, there)
            table[at] = np.maximum(table[at], said)
            yield
