"""Chain solver: dynamic programming over candidates of each subgoal.

One check draws a few candidates for every subgoal, near the best so far and far from it, and finds the best combination
of all of them: m values at each of s subgoals are m**s chains for s * m**2 model inputs.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.chain_structure import (
    ChainObjective,
    best_chain,
    blocks_of,
    forward_costs,
    links_of,
    pairwise_costs,
    through_costs,
)
from tailor.executive.refinement.solvers.solver import Limits, Solver

FAR_SHARE = 0.125  # of the candidates are drawn from the whole range, so that every basin is sampled eventually
DECADES = 3.5  # near candidates step by 10**-3.5 to all of the range
N_ELITE = 4  # candidates of a subgoal that survive a check


class ChainSolver(Solver):
    """Dynamic programming over candidate subgoals, drawn anew at every check around the best chain.

    Args:
      objective: Sum of stages in which every free parameter occurs only in neighbouring stages.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d).
      batch: Maximum number of model inputs of a stage in one check.
      limits: End of the search.

    Raises:
      ValueError: The stages form no chain.
    """

    def __init__(
        self,
        objective: ChainObjective,
        rng: np.random.Generator,
        seeds: Array,
        batch: int,
        limits: Limits,
    ) -> None:
        super().__init__(objective, rng, seeds, limits)
        blocks = blocks_of(objective.stages)
        if blocks is None:
            raise ValueError("a parameter occurs in actions that are not neighbours: not a chain")
        self._blocks = blocks
        self._links = links_of(objective.stages, blocks)
        paired = any(len(a) and len(b) for a, b in pairwise(blocks))
        self._n_candidates = max(N_ELITE + 2, int(np.sqrt(batch)) if paired else batch // 2)
        self._elite = [self._seeds[:, block] for block in blocks]

    def _check(self) -> None:
        drawn = [self._candidates(index) for index in range(len(self._blocks))]
        costs = [
            pairwise_costs(link, before, own)
            for link, before, own in zip(self._links, [np.empty((1, 0)), *drawn], drawn, strict=False)
        ]
        forward = forward_costs(costs)
        candidate = np.empty(self._objective.ranges.count)
        for block, candidates, chosen in zip(self._blocks, drawn, best_chain(costs, forward), strict=True):
            candidate[block] = candidates[chosen]
        self._consider(candidate, float(forward[-1].min()))
        for index, through in enumerate(through_costs(costs, forward)):
            self._update_elite(index, drawn[index], through)

    def _update_elite(self, index: int, drawn: Array, through: Array) -> None:
        """Keep the overall best value of a subgoal and the values on the best chains of this check."""
        order = np.argsort(through, kind="stable")[:N_ELITE]
        valid = order[np.isfinite(through[order])]
        best = [] if self.best is None else [self.best[self._blocks[index]]]
        if best or len(valid):
            self._elite[index] = np.vstack([*best, drawn[valid]])

    def _candidates(self, index: int) -> Array:
        """Values of one subgoal, shape (m, len(block)): the elite, steps from it, and far ones."""
        block, elite = self._blocks[index], self._elite[index]
        if not len(block):
            return np.empty((1, 0))
        ranges = self._objective.ranges.part(block)
        elite = elite[: self._n_candidates // 2]
        n_new = self._n_candidates - len(elite)
        n_far = n_new if not len(elite) else max(1, round(FAR_SHARE * n_new))
        n_near = n_new - n_far
        far = ranges.draw(n_far, self._rng)
        return np.vstack([elite, far, ranges.confine(self._steps(elite, n_near, ranges.width))])

    def _steps(self, elite: Array, count: int, width: Array) -> Array:
        """Normal steps from the elite at many scales, half of them along a single parameter."""
        if not count:
            return np.empty((0, len(width)))
        origin = elite[self._rng.integers(0, len(elite), count)]
        scale = 10.0 ** -(DECADES * self._rng.random((count, 1)))
        step = scale * self._rng.standard_normal(origin.shape)
        axis = np.arange(len(width)) == self._rng.integers(0, len(width), (count, 1))
        along_axis = self._rng.random((count, 1)) < 0.5
        return origin + width * np.where(along_axis & ~axis, 0.0, step)
