"""Chain of subgoals whose parameters are partitioned into boxes, with a lower bound for each pair of adjacent boxes.

Dynamic programming over the boxes gives the minimum over all chains, a lower bound on the cost of every choice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.boxes import NO_PARAMETERS, Boxes, joined
from tailor.executive.refinement.solvers.chain_structure import best_chain, forward_costs, through_costs

Indices = NDArray[np.intp]


class PairBound(Protocol):
    """Lower bound on the cost of a pair of boxes."""

    @property
    def effort(self) -> int:
        """Approximate number of elementary comparisons for one pair."""
        ...

    def lower_bound(self, before: Boxes, own: Boxes) -> Array:
        """Seconds, shape (len(before), len(own))."""
        ...


@dataclass(frozen=True, slots=True)
class Costs:
    """Lower bounds of chains by subgoal: from the start up to each box, and of whole chains through it."""

    forward: list[Array]
    through: list[Array]

    def rest(self, index: int) -> Array:
        """From each box of a subgoal to the end; inf if no chain passes through the box."""
        through, forward = self.through[index], self.forward[index]
        return np.where(np.isfinite(through), through - np.where(np.isfinite(forward), forward, 0.0), np.inf)


class BoxChain:
    """Boxes and pair bounds of s subgoals; the boxes of one subgoal are replaced at a time.

    Args:
      bounds: Lower bound of a pair of boxes for each action.
      boxes: Initial boxes of each subgoal.
      effort: Approximate number of elementary comparisons in one step.
      min_pieces: Minimum number of pieces that the boxes chosen are split into at a time.
    """

    def __init__(self, bounds: Sequence[PairBound], boxes: Sequence[Boxes], effort: int, min_pieces: int) -> None:
        self.boxes = list(boxes)
        self._min_pieces = min_pieces
        self._bounds = bounds
        self._effort = effort
        self._tables = [
            np.full((len(before), len(own)), -np.inf)
            for before, own in zip([NO_PARAMETERS, *boxes], boxes, strict=False)
        ]

    @property
    def steps(self) -> float:
        """Approximate number of steps that `begin` takes."""
        efforts = (bound.effort * table.size for bound, table in zip(self._bounds, self._tables, strict=True))
        return sum(efforts) / self._effort

    def begin(self) -> Iterator[None]:
        """Bound all pairs, in steps."""
        for index, table in enumerate(self._tables):
            every = np.arange(table.shape[0]), np.arange(table.shape[1])
            yield from self._bound(index, table, *every)

    def costs(self) -> Costs:
        """Lower bounds of chains from the pair bounds so far."""
        forward = forward_costs(self._tables)
        return Costs(forward, through_costs(self._tables, forward))

    def cheapest(self, costs: Costs) -> list[int]:
        """Index of the cheapest chain's box at each subgoal."""
        return best_chain(self._tables, costs.forward)

    def split(
        self, index: int, kept: Indices, chosen: Indices, weight: Array, costs: Costs, limit: float
    ) -> Iterator[None]:
        """Split the chosen boxes of a subgoal and discard all but their pieces and the kept boxes, in steps.

        Pieces inherit the bounds of their box. Those on chains with a bound below `limit` are bounded anew.
        """
        pieces, parents = self.boxes[index].part(chosen), chosen
        while len(parents) < self._min_pieces:
            pieces, parents = pieces.halves(weight), np.tile(parents, 2)
        parents = np.concatenate([kept, parents])
        new = np.arange(len(kept), len(parents))
        before = costs.forward[index - 1] if index else np.zeros(1)
        last = index + 1 == len(self.boxes)
        after = np.zeros(1) if last else costs.rest(index + 1)
        left = self._tables[index]
        left_open = (before[:, None] + left[:, chosen] + costs.rest(index)[chosen] < limit).any(axis=1)
        self.boxes[index] = joined(self.boxes[index].part(kept), pieces)
        self._tables[index] = left[:, parents]
        if not last:
            right = self._tables[index + 1]
            right_open = (costs.forward[index][chosen, None] + right[chosen] + after < limit).any(axis=0)
            self._tables[index + 1] = right[parents]
        yield from self._bound(index, self._tables[index], np.flatnonzero(left_open), new)
        if not last:
            yield from self._bound(index + 1, self._tables[index + 1], new, np.flatnonzero(right_open))

    def _bound(self, index: int, table: Array, before: Indices, own: Indices) -> Iterator[None]:
        """Raise some entries of a table to the bounds of their boxes, a few in each step."""
        first = self.boxes[index - 1] if index else NO_PARAMETERS
        n_pairs = max(1, self._effort // self._bounds[index].effort)
        height = max(1, min(len(before), n_pairs))
        width = max(1, n_pairs // height)
        for i, j in product(range(0, len(before), height), range(0, len(own), width)):
            rows, columns = before[i : i + height], own[j : j + width]
            bounds = self._bounds[index].lower_bound(first.part(rows), self.boxes[index].part(columns))
            block = np.ix_(rows, columns)
            table[block] = np.maximum(table[block], bounds)
            yield
