"""How near a choice is to the optimum of the models: a lower bound by branch and bound, and the gap to it.

Boxes on the cheapest chains are halved until no chain is cheaper than the choice less the gap that is good enough. What
a box costs at least comes from the leaves that it meets, so that thresholds and kinks count, not slopes alone.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from itertools import count

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.bound_stagnation import BoundStagnation
from tailor.executive.refinement.certificates.box_chain import BoxChain, Costs
from tailor.executive.refinement.certificates.boxes import NOWHERE, box_of
from tailor.executive.refinement.certificates.sensitivity import sensitivity
from tailor.executive.refinement.certificates.stage_bounds import NoBound, StageBound, stage_bound
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain import Columns, blocks_of, links_of

EFFORT = 120_000  # comparisons of boxes and leaves in one check: about 1 ms, up to 4 while boxes are wide
HOPELESS = 0.3  # of the checks just to begin: what is left will not get far
LOOK_EVERY = 4  # turns of cutting
BOXES_MAX = 1000  # of a subgoal: more take longer to go through than to bound
NARROWEST = 1e-5  # of a range: below, single precision says what is gained
FIRST_CUTS = 6, 4  # before anything is bounded: of the only subgoal that has free parameters, of each of several
CUT_AT_ONCE = 12, 4  # boxes of a subgoal, likewise: a turn costs more than its boxes where they are no pairs
PIECES = 48, 16  # that the boxes chosen are cut into at a time, likewise: pairs of boxes take longer


class Certificate:
    """Proves that no choice costs less than `bound`; anytime and resumable, without a random draw.

    On the way it may come across a choice that is better than the one it was given: `best`, which costs `value`.

    Args:
      objective: What was minimised.
      blocks: The columns of each subgoal.
      bounds: Of the objective's stages.
      best: The choice, shape (d,).
      settings: The gap that is good enough, and how much may be spent.
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
        self._given = self.value
        self.checks = 0
        self.finished = False
        self._objective = objective
        self._blocks = blocks
        self._settings = settings
        self._bounds = bounds
        self._several = sum(map(bool, map(len, blocks))) > 1  # subgoals that have free parameters
        self._work = self._prove()

    @property
    def gap_pct(self) -> float | None:
        """The given choice costs at most so much more than the optimum; None while that cannot be said."""
        return 100 * (self._given / self.bound - 1) if 0 < self.bound <= self.value < np.inf else None

    def advance(self, budget: Budget) -> None:
        """Prove on until the budget is spent or no more can be proven."""
        while not self.finished and not budget.spent():
            self.checks += 1
            done = next(self._work, True)
            self.finished = done is not None or self.checks >= self._settings.certify_checks

    @property
    def _limit(self) -> float:
        """A bound that is good enough."""
        return self.value / (1 + self._settings.certify_gap_pct / 100)

    def _prove(self) -> Iterator[None]:
        """The proof, in steps of one check each."""
        weight = sensitivity(self._objective)
        yield
        chain = yield from self._boxes(weight)
        if chain.steps > HOPELESS * self._settings.certify_checks:
            return
        yield from chain.begin()
        stalling, free = BoundStagnation(), [index for index, block in enumerate(self._blocks) if len(block)] or [0]
        for turn in count():
            index = free[turn % len(free)]
            costs = chain.costs()
            if self._note(costs) or stalling.stalls(self.bound, self.value):
                return
            if turn % LOOK_EVERY == LOOK_EVERY - 1:
                self._look(chain, costs)
            kept, chosen = self._chosen(chain, costs, index)
            if len(chosen):
                yield from chain.cut(index, kept, chosen, weight[self._blocks[index]], costs, self._limit)

    def _boxes(self, weight: Array) -> Generator[None, None, BoxChain]:
        """The first boxes, and bounds for what lies inside of all of them: a check for each action."""
        boxes = [box_of(self._objective.ranges.part(block)) for block in self._blocks]
        bounds = []
        for bound, *ends in zip(self._bounds, [NOWHERE, *boxes], boxes, strict=False):
            bounds.append(bound.within(*ends))
            yield
        free = [i for i, block in enumerate(self._blocks) if len(block)]
        for i in free * FIRST_CUTS[self._several]:
            boxes[i] = boxes[i].halves(weight[self._blocks[i]])
        return BoxChain(bounds, boxes, EFFORT, PIECES[self._several])

    def _note(self, costs: Costs) -> bool:
        """Take up what is proven; whether it is good enough."""
        # what was forgotten costs at least the limit of its time, which only falls
        self.bound = max(self.bound, min(float(costs.through[-1].min(initial=np.inf)), self._limit))
        return self.bound >= self._limit

    def _look(self, chain: BoxChain, costs: Costs) -> None:
        """Take the middle of the cheapest chain of boxes where it is a better choice."""
        if not np.isfinite(costs.through[-1]).any():
            return
        candidate = self.best.copy()
        for block, boxes, chosen in zip(self._blocks, chain.boxes, chain.cheapest(costs), strict=True):
            candidate[block] = boxes.middle[chosen]
        value = float(self._objective(candidate[None])[0])
        if value < self.value:
            self.best, self.value = candidate, value

    def _chosen(self, chain: BoxChain, costs: Costs, index: int) -> tuple[Columns, Columns]:
        """Of a subgoal's boxes those that are kept as they are, and those to cut: the cheapest that can be."""
        boxes, through = chain.boxes[index], costs.through[index]
        kept = through < self._limit
        alive = np.flatnonzero(kept)
        widest = (boxes.width[alive] / self._objective.ranges.width[self._blocks[index]]).max(axis=1, initial=0.0)
        able = alive[widest > NARROWEST]
        able = able[np.argsort(through[able], kind="stable")] if len(boxes) < BOXES_MAX else able[:0]
        chosen = able[: CUT_AT_ONCE[self._several]]
        kept[chosen] = False
        return np.flatnonzero(kept), chosen


def certificate(objective: SequenceObjective, best: Array, settings: RefinementSettings) -> Certificate | NoBound:
    """A proof of how good a choice is, shape (d,), or why there can be none."""
    blocks = blocks_of(objective.stages)
    if blocks is None:
        return NoBound("a parameter occurs in actions that are not neighbours")
    bounds = []
    for stage, link in zip(objective.stages, links_of(objective.stages, blocks), strict=True):
        bound = stage_bound(stage, link, settings)
        if isinstance(bound, NoBound):
            return bound
        bounds.append(bound)
    return Certificate(objective, blocks, bounds, best, settings)
