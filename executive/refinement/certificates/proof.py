"""Branch and bound over the boxes of all subgoals, which form chains.

Boxes on the cheapest chains are bisected until no chain is cheaper than the choice less the accepted gap. The bound of
a box comes from the tree leaves that it intersects, so that thresholds and kinks count, not slopes alone.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from itertools import count

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.bound_stagnation import BoundStagnation
from tailor.executive.refinement.certificates.box_chain import BoxChain, Costs
from tailor.executive.refinement.certificates.boxes import NO_PARAMETERS, box_of
from tailor.executive.refinement.certificates.partition import partition
from tailor.executive.refinement.certificates.sensitivity import sensitivity
from tailor.executive.refinement.certificates.stage_bounds import StageBound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain_structure import Columns

EFFORT = 120_000  # comparisons of boxes and leaves in one check: 3 to 7 ms with networks
MAX_SETUP_SHARE = 0.3  # of the checks for the initial bounds: a proof with a larger share does not converge
PROBE_PERIOD = 4  # iterations
MAX_BOXES = 1000  # of a subgoal: the passes over more take longer than their bounds
MIN_WIDTH = 1e-5  # share of a range: below, the gain is within single precision


class Proof:
    """Proves that no choice costs less than `bound`, in steps and without random draws.

    It may find a choice that is better than the given one: `best`, which costs `value`.

    Args:
      objective: Cost that was minimised.
      blocks: Columns of each subgoal.
      bounds: Lower bounds of the objective's stages.
      best: The given choice, shape (d,).
      settings: Accepted gap and number of checks.
    """

    def __init__(
        self,
        objective: SequenceObjective,
        blocks: tuple[Columns, ...],
        bounds: Sequence[StageBound],
        best: Array,
        settings: RefinementSettings,
    ) -> None:
        self.bound = -np.inf  # seconds
        self.best = best
        self.value = float(objective(best[None])[0])
        self._objective = objective
        self._blocks = blocks
        self._settings = settings
        self._bounds = bounds
        self._free = [index for index, block in enumerate(blocks) if len(block)] or [0]
        self._partition = partition(len(self._free), all(bound.is_linear for bound in bounds))

    @property
    def _limit(self) -> float:
        """Bound at which the gap is accepted."""
        return self.value / (1 + self._settings.certify_gap_pct / 100)

    @property
    def _goal(self) -> float:
        """The next bound to reach, at most the limit."""
        goals = [self.value / (1 + gap_pct / 100) for gap_pct in self._partition.goals_pct]
        return min([self._limit, *(goal for goal in goals if goal > self.bound)])

    def steps(self) -> Iterator[None]:
        """The proof, in steps of one check each."""
        weight = sensitivity(self._objective)
        yield
        chain = yield from self._initial_chain(weight)
        if chain.steps > MAX_SETUP_SHARE * self._settings.certify_checks:
            return
        yield from chain.begin()
        stagnation = BoundStagnation()
        for iteration in count():
            costs = chain.costs()
            if self._raise_bound(costs):
                return
            if iteration % PROBE_PERIOD == PROBE_PERIOD - 1:
                self._probe_cheapest_chain(chain, costs)
            if chain.inherits(costs.cheapest()):
                chain.raise_cheapest(costs, self._goal)
            elif stagnation.update(self.bound, self.value):
                return
            else:
                self._split(chain, costs, weight)
            yield

    def _initial_chain(self, weight: Array) -> Generator[None, None, BoxChain]:
        """Initial boxes, and bounds restricted to them: one check for each action."""
        boxes = [box_of(self._objective.ranges.part(block)) for block in self._blocks]
        bounds = []
        for bound, *ends in zip(self._bounds, [NO_PARAMETERS, *boxes], boxes, strict=False):
            bounds.append(bound.within(*ends))
            yield
        for i in self._free * self._partition.initial_splits:
            boxes[i] = boxes[i].halves(weight[self._blocks[i]])
        return BoxChain(bounds, boxes, EFFORT)

    def _raise_bound(self, costs: Costs) -> bool:
        """Raise the bound to the cheapest chain; whether the gap is accepted."""
        # Discarded boxes cost at least the limit of their time, which only falls.
        self.bound = max(self.bound, min(float(costs.through[-1].min(initial=np.inf)), self._limit))
        return self.bound >= self._limit

    def _probe_cheapest_chain(self, chain: BoxChain, costs: Costs) -> None:
        """Adopt the middle of the cheapest chain of boxes if it is a better choice."""
        if not np.isfinite(costs.through[-1]).any():
            return
        candidate = self.best.copy()
        for block, boxes, chosen in zip(self._blocks, chain.boxes, costs.cheapest(), strict=True):
            candidate[block] = boxes.middle[chosen]
        value = float(self._objective(candidate[None])[0])
        if value < self.value:
            self.best, self.value = candidate, value

    def _split(self, chain: BoxChain, costs: Costs, weight: Array) -> None:
        """Split the cheapest boxes of every subgoal."""
        for index in self._free:
            kept, chosen = self._select_boxes(chain, costs, index)
            if len(chosen):
                chain.split(index, kept, chosen, weight[self._blocks[index]], self._partition.min_pieces)

    def _select_boxes(self, chain: BoxChain, costs: Costs, index: int) -> tuple[Columns, Columns]:
        """Indices of a subgoal's boxes to keep unchanged, and of those to split: the cheapest that are wide enough."""
        boxes, through = chain.boxes[index], costs.through[index]
        kept = through < self._limit
        open_boxes = np.flatnonzero(through < self._goal)
        ranges, width = self._objective.ranges.width[self._blocks[index]], boxes.width[open_boxes]
        widest = np.divide(width, ranges, out=np.zeros_like(width), where=ranges > 0).max(axis=1, initial=0.0)
        wide = open_boxes[widest > MIN_WIDTH]
        wide = wide[np.argsort(through[wide], kind="stable")] if len(boxes) < MAX_BOXES else wide[:0]
        chosen = wide[: self._partition.max_split_boxes]
        kept[chosen] = False
        return np.flatnonzero(kept), chosen
