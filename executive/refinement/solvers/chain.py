"""Chain solver: dynamic programming over candidates of each subgoal.

One check draws a few candidates for every subgoal, near the best so far and far from it, and finds the best combination
of all of them: m values at each of s subgoals are m**s chains for s * m**2 model inputs. The next two checks move every
second subgoal, and then the others. Their neighbours stay, so many more candidates cost as much.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.chain_structure import (
    ChainObjective,
    Link,
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
N_ELITE = 6  # candidates of a subgoal that survive a check
MIN_DISTANCE = 0.03  # share of a range between two of them
TURNS = 3  # checks: all subgoals, every second one, the others
COARSE_FACTOR = 2  # of the candidates in the first check: its models have a sixth of the inputs


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
        self._coarse_links = links_of(objective.coarse_stages, blocks)
        self._paired = any(len(a) and len(b) for a, b in pairwise(blocks))
        self._n_single = batch // 2  # candidates of a subgoal if its neighbours stay
        self._n_candidates = max(N_ELITE + 2, int(np.sqrt(batch))) if self._paired else self._n_single
        self._elite = [self._seeds[:, block] for block in blocks]

    def _check(self) -> None:
        first_look = self.checks == 1 and self._paired
        values = self._values(COARSE_FACTOR * self._n_candidates) if first_look else self._values_to_combine()
        candidate, cost, through = self._best_combination(self._coarse_links if first_look else self._links, values)
        if first_look:
            choices = np.vstack([candidate, self._seeds])
            self._consider_all(choices, self._objective(choices))
        else:
            self._consider(candidate, cost)
        for index, (drawn, costs) in enumerate(zip(values, through, strict=True)):
            if len(drawn) > 1:
                self._update_elite(index, drawn, costs)

    def _values_to_combine(self) -> list[Array]:
        """Values of every subgoal in this check, in turns: few of all subgoals, many of every second, of the others."""
        turn = self.checks % TURNS
        if self.best is None or not self._paired or turn == TURNS - 1:
            return self._values(self._n_candidates)
        best = self.best
        return [
            self._candidates(index, self._n_single, best[None, block]) if index % 2 == turn else best[None, block]
            for index, block in enumerate(self._blocks)
        ]

    def _values(self, count: int) -> list[Array]:
        return [self._candidates(index, count, elite) for index, elite in enumerate(self._elite)]

    def _best_combination(self, links: tuple[Link, ...], values: list[Array]) -> tuple[Array, float, list[Array]]:
        """Best candidate and its cost, and the least cost of a chain through each value."""
        costs = [
            pairwise_costs(link, before, own)
            for link, before, own in zip(links, [np.empty((1, 0)), *values], values, strict=False)
        ]
        forward = forward_costs(costs)
        candidate = np.empty(self._objective.ranges.count)
        for block, own, chosen in zip(self._blocks, values, best_chain(costs, forward), strict=True):
            candidate[block] = own[chosen]
        return candidate, float(forward[-1].min()), through_costs(costs, forward)

    def _update_elite(self, index: int, drawn: Array, through: Array) -> None:
        """Keep the overall best value of a subgoal, and the values on the best chains of this check that lie apart."""
        block = self._blocks[index]
        order = np.argsort(through, kind="stable")
        order = order[np.isfinite(through[order])]
        apart = MIN_DISTANCE * self._objective.ranges.width[block]
        elite = [] if self.best is None else [self.best[block]]
        for value in drawn[order]:
            if len(elite) > N_ELITE:
                break
            if all((np.abs(value - other) > apart).any() for other in elite):
                elite.append(value)
        if elite:
            self._elite[index] = np.array(elite)

    def _candidates(self, index: int, count: int, elite: Array) -> Array:
        """Values of one subgoal, shape (count, len(block)): the elite, steps from it, and far ones."""
        block = self._blocks[index]
        if not len(block):
            return np.empty((1, 0))
        ranges = self._objective.ranges.part(block)
        elite = elite[: count // 2]
        n_new = count - len(elite)
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
