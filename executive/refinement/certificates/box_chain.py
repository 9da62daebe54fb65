"""Chain of subgoals whose parameters are partitioned into boxes, with a lower bound for each pair of adjacent boxes.

Dynamic programming over the boxes gives the minimum over all chains, a lower bound on the cost of every choice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.boxes import NO_PARAMETERS, Boxes, joined
from tailor.executive.refinement.certificates.joint_bounds import joint_bounds
from tailor.executive.refinement.certificates.pair_bounds import Indices, unknown
from tailor.executive.refinement.certificates.stage_bounds import StageBound
from tailor.executive.refinement.solvers.chain_structure import best_chain, forward_costs, through_costs


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

    def through_pairs(self, index: int) -> Array:
        """Of the cheapest chain through each pair of boxes of an action."""
        through: Array = self.before(index)[:, None] + self.tables[index] + self.rest(index)
        return through

    def cheapest(self) -> list[int]:
        """Index of the cheapest chain's box at each subgoal."""
        return best_chain(self.tables, self.forward)


class BoxChain:
    """Boxes and pair bounds of s subgoals.

    Pieces of a box inherit its bounds; the pairs on the cheapest chains are bounded anew first.

    Args:
      bounds: Lower bounds of pairs of boxes for each action.
      boxes: Initial boxes of each subgoal.
      effort: Approximate number of elementary comparisons in one step.
    """

    def __init__(self, bounds: Sequence[StageBound], boxes: Sequence[Boxes], effort: int) -> None:
        self.boxes = list(boxes)
        self._tilts = [np.zeros_like(each.lower) for each in boxes]
        self._bounds = bounds
        self._effort = effort
        sides = zip(bounds, [NO_PARAMETERS, *boxes], boxes, strict=False)
        self._pairs = [unknown((len(before), len(own)), before, own, bound.is_linear) for bound, before, own in sides]
        self._inherited = [np.ones(pairs.middle.shape, bool) for pairs in self._pairs]

    @property
    def steps(self) -> float:
        """Approximate number of steps that `begin` takes."""
        efforts = (bound.effort * pairs.middle.size for bound, pairs in zip(self._bounds, self._pairs, strict=True))
        return sum(efforts) / self._effort

    def begin(self) -> Iterator[None]:
        """Bound all pairs, in steps."""
        while any(each.any() for each in self._inherited):
            self._raise_first([np.where(each, 0.0, np.inf) for each in self._inherited], np.inf)
            yield

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

    def inherits(self, chain: Sequence[int]) -> bool:
        """Whether a bound of a chain, given by its boxes' indices, is that of boxes before their split."""
        return any(each[pair] for each, pair in zip(self._inherited, pairwise([0, *chain]), strict=True))

    def split(self, index: int, kept: Indices, chosen: Indices, weight: Array, min_pieces: int) -> None:
        """Split the chosen boxes of a subgoal into at least so many pieces; keep some others, discard the rest."""
        pieces, parents = self.boxes[index].part(chosen), chosen
        while len(parents) < min_pieces:
            pieces, parents = pieces.halves(weight), np.tile(parents, 2)
        parents = np.concatenate([kept, parents])
        split = joined(self.boxes[index].part(kept), pieces)
        moved = split.middle - self.boxes[index].middle[parents]
        self.boxes[index] = split
        self._tilts[index] = self._tilts[index][parents]
        self._pairs[index] = self._pairs[index].of_pieces(parents, moved)
        self._inherited[index] = self._inherited[index][:, parents]
        self._inherited[index][:, len(kept) :] = True
        if index + 1 < len(self.boxes):
            self._pairs[index + 1] = self._pairs[index + 1].from_pieces(parents, moved)
            self._inherited[index + 1] = self._inherited[index + 1][parents]
            self._inherited[index + 1][len(kept) :] = True

    def raise_cheapest(self, costs: Costs, limit: float) -> None:
        """Bound pairs with inherited bounds anew, in one step: those on the cheapest chains below `limit`."""
        through = (costs.through_pairs(index) for index in range(len(self._pairs)))
        tables = zip(self._inherited, through, strict=True)
        self._raise_first([np.where(inherited, cost, np.inf) for inherited, cost in tables], limit)

    def _raise_first(self, order: Sequence[Array], limit: float) -> None:
        """Bound pairs whose number in `order`, for each pair of each action, is the least and below `limit`."""
        sizes = [each.size for each in order]
        numbers, efforts = np.concatenate([each.ravel() for each in order]), [bound.effort for bound in self._bounds]
        pairs = np.flatnonzero(numbers < limit)
        pairs = pairs[np.argsort(numbers[pairs], kind="stable")]
        within = np.searchsorted(np.cumsum(np.repeat(efforts, sizes)[pairs]), self._effort, side="right")
        pairs = np.sort(pairs[: max(1, int(within))])
        ends = np.cumsum(sizes)
        parts = np.split(pairs, np.searchsorted(pairs, ends[:-1]))
        places = [
            np.unravel_index(part - end + size, each.shape)
            for part, end, size, each in zip(parts, ends, sizes, order, strict=True)
        ]
        self._raise([(index, *place) for index, place in enumerate(places) if len(place[0])])

    def _raise(self, places: Sequence[tuple[int, Indices, Indices]]) -> None:
        """Bound pairs anew: for each action the boxes before, and the own ones."""
        before = [NO_PARAMETERS, *self.boxes]
        requests = [(self._bounds[i], before[i].part(rows), self.boxes[i].part(columns)) for i, rows, columns in places]
        for bounds, (index, *place) in zip(joint_bounds(requests), places, strict=True):
            self._pairs[index].raise_to(bounds, *place)
            self._inherited[index][tuple(place)] = False
