"""Chain of subgoals whose parameters are partitioned into boxes, with a lower bound for each pair of adjacent boxes.

Dynamic programming over the boxes gives the minimum over all chains, a lower bound on the cost of every choice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.boxes import NO_PARAMETERS, Boxes, joined
from tailor.executive.refinement.certificates.pair_bounds import Indices, PairBounds, unknown
from tailor.executive.refinement.solvers.chain_structure import best_chain, forward_costs, through_costs


class ActionBound(Protocol):
    """Lower bounds on the cost of an action."""

    @property
    def effort(self) -> int:
        """Approximate number of elementary comparisons for one pair of boxes."""
        ...

    @property
    def is_linear(self) -> bool:
        """Whether the bounds are linear; others are computed faster for all pairs of some boxes at once."""
        ...

    def lower_bounds(self, before: Boxes, own: Boxes, paired: bool = False) -> PairBounds:
        """Bounds for each pair of boxes of the subgoals before and after the action."""
        ...


@dataclass(frozen=True, slots=True)
class Costs:
    """Lower bounds of chains by subgoal: from the start up to each box, and of whole chains through it."""

    tables: list[Array]  # of each action for each pair of boxes
    forward: list[Array]
    through: list[Array]

    def before(self, index: int) -> Array:
        """Up to each box of the subgoal before."""
        return self.forward[index - 1] if index else np.zeros(1)

    def rest(self, index: int) -> Array:
        """From each box of a subgoal to the end; inf if no chain passes through the box; zero after the last."""
        if index == len(self.through):
            return np.zeros(1)
        through, forward = self.through[index], self.forward[index]
        return np.where(np.isfinite(through), through - np.where(np.isfinite(forward), forward, 0.0), np.inf)

    def cheapest(self) -> list[int]:
        """Index of the cheapest chain's box at each subgoal."""
        return best_chain(self.tables, self.forward)


class BoxChain:
    """Boxes and pair bounds of s subgoals; the boxes of one subgoal are replaced at a time.

    Args:
      bounds: Lower bounds of pairs of boxes for each action.
      boxes: Initial boxes of each subgoal.
      effort: Approximate number of elementary comparisons in one step.
      min_pieces: Minimum number of pieces that the boxes chosen are split into at a time.
    """

    def __init__(self, bounds: Sequence[ActionBound], boxes: Sequence[Boxes], effort: int, min_pieces: int) -> None:
        self.boxes = list(boxes)
        self._tilts = [np.zeros_like(each.lower) for each in boxes]
        self._min_pieces = min_pieces
        self._bounds = bounds
        self._effort = effort
        sides = zip(bounds, [NO_PARAMETERS, *boxes], boxes, strict=False)
        self._pairs = [unknown((len(before), len(own)), before, own, bound.is_linear) for bound, before, own in sides]

    @property
    def steps(self) -> float:
        """Approximate number of steps that `begin` takes."""
        efforts = (bound.effort * pairs.middle.size for bound, pairs in zip(self._bounds, self._pairs, strict=True))
        return sum(efforts) / self._effort

    def begin(self) -> Iterator[None]:
        """Bound all pairs, in steps."""
        for index, pairs in enumerate(self._pairs):
            every = (np.arange(count) for count in pairs.middle.shape)
            yield from self._bound(index, np.ones(pairs.middle.shape, bool), *every)

    def costs(self) -> Costs:
        """Lower bounds of chains from the pair bounds so far, with tilts for the cheapest chain through each box."""
        costs = self._costs()
        if not any(bound.is_linear for bound in self._bounds):
            return costs
        self._tilt(costs)
        return self._costs()

    def _costs(self) -> Costs:
        sides = zip(
            [NO_PARAMETERS, *self.boxes], self.boxes, [NO_PARAMETERS.lower, *self._tilts], self._tilts, strict=False
        )
        tables = [pairs.least(*side) for pairs, side in zip(self._pairs, sides, strict=True)]
        forward = forward_costs(tables)
        return Costs(tables, forward, through_costs(tables, forward))

    def _tilt(self, costs: Costs) -> None:
        """Tilt each box by half the difference of the two actions' slopes on the cheapest chain through it."""
        for index, (first, second) in enumerate(pairwise(self._pairs)):
            boxes = np.arange(len(self.boxes[index]))
            before = np.argmin(costs.before(index)[:, None] + costs.tables[index], axis=0)
            after = np.argmin(costs.tables[index + 1] + costs.rest(index + 1), axis=1)
            self._tilts[index][:] = (second.slope(0, boxes, after) - first.slope(1, before, boxes)) / 2

    def split(
        self, index: int, kept: Indices, chosen: Indices, weight: Array, costs: Costs, limit: float
    ) -> Iterator[None]:
        """Split the chosen boxes of a subgoal and discard all but their pieces and the kept boxes, in steps.

        Pieces inherit the bounds of their box. Those on chains with a bound below `limit` are bounded anew.
        """
        pieces, parents = self.boxes[index].part(chosen), chosen
        while len(parents) < self._min_pieces:
            pieces, parents = pieces.halves(weight), np.tile(parents, 2)
        place = np.tile(np.arange(len(chosen)), len(parents) // len(chosen))  # of each piece's parent among the chosen
        parents = np.concatenate([kept, parents])
        new = np.arange(len(kept), len(parents))
        last = index + 1 == len(self.boxes)
        left = costs.before(index)[:, None] + costs.tables[index][:, chosen] + costs.rest(index)[chosen]
        split = joined(self.boxes[index].part(kept), pieces)
        moved = split.middle - self.boxes[index].middle[parents]
        self.boxes[index] = split
        self._tilts[index] = self._tilts[index][parents]
        self._pairs[index] = self._pairs[index].of_pieces(parents, moved)
        if not last:
            right = costs.forward[index][chosen, None] + costs.tables[index + 1][chosen] + costs.rest(index + 1)
            self._pairs[index + 1] = self._pairs[index + 1].from_pieces(parents, moved)
        yield from self._bound(index, (left < limit)[:, place], np.arange(len(left)), new)
        if not last:
            yield from self._bound(index + 1, (right < limit)[place], new, np.arange(right.shape[1]))

    def _bound(self, index: int, open_pairs: NDArray[np.bool_], before: Indices, own: Indices) -> Iterator[None]:
        """Raise the bounds of open pairs, (len(before), len(own)), a few in each step."""
        first, bound = self.boxes[index - 1] if index else NO_PARAMETERS, self._bounds[index]
        n_pairs = max(1, self._effort // bound.effort)
        if bound.is_linear:
            rows, columns = np.nonzero(open_pairs)
            for i in range(0, len(rows), n_pairs):
                part = before[rows[i : i + n_pairs]], own[columns[i : i + n_pairs]]
                bounds = bound.lower_bounds(first.part(part[0]), self.boxes[index].part(part[1]), paired=True)
                self._pairs[index].raise_to(bounds, *part)
                yield
            return
        before, own = before[open_pairs.any(axis=1)], own[open_pairs.any(axis=0)]
        height = max(1, min(len(before), n_pairs))
        width = max(1, n_pairs // height)
        for i, j in product(range(0, len(before), height), range(0, len(own), width)):
            rows, columns = before[i : i + height], own[j : j + width]
            bounds = bound.lower_bounds(first.part(rows), self.boxes[index].part(columns))
            self._pairs[index].raise_to(bounds, rows[:, None], columns)
            yield
