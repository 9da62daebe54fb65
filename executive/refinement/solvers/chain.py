"""Chain solver: dynamic programming over candidates of each subgoal.

One check draws a few candidates for every subgoal, near the best so far and far from it, and finds the best combination
of all of them: m values at each of s subgoals are m**s chains for s * m**2 model inputs. The next checks move every
second subgoal, and then the others. Their neighbours stay, so many more candidates cost as much.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.chain_candidates import N_ELITE, Candidates
from tailor.executive.refinement.solvers.chain_structure import (
    ChainObjective,
    Link,
    best_chain,
    blocks_of,
    forward_costs,
    links_of,
    pair_costs,
    through_costs,
)
from tailor.executive.refinement.solvers.solver import Limits, Solver

TURNS = 5  # checks: all subgoals, then every second one and the others, twice
MAX_BATCHES, MAX_SINGLES = 5.5, 3  # model inputs of one check in batches: more subgoals have fewer candidates each
MIN_SINGLES = 4  # candidates of a subgoal: the kept one, one from the whole range, and steps


class ChainSolver(Solver):
    """Dynamic programming over candidate subgoals, drawn anew at every check around the best chain.

    Args:
      objective: Sum of stages in which every free parameter occurs only in neighbouring stages.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d).
      batch: Pairs of candidates of two neighbouring subgoals in one check; fewer from seven subgoals on.
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
        self._chain = objective
        self._blocks = blocks
        self._links = links_of(objective.stages, blocks)
        self._coarse_links = links_of(objective.coarse_stages, blocks)
        n_pairs = sum(bool(len(a) and len(b)) for a, b in pairwise(blocks))
        self._paired = n_pairs > 0
        # candidates of a subgoal if its neighbours stay, and of all subgoals
        self._n_single = max(MIN_SINGLES, min(3 * batch // 8, MAX_SINGLES * batch // (n_pairs + 1)))
        each = min(batch, MAX_BATCHES * batch / max(1, n_pairs))
        self._n_candidates = max(N_ELITE + 2, int(np.sqrt(each))) if self._paired else batch // 2
        self._candidates = Candidates(objective.ranges, blocks, rng, self._seeds)

    def _check(self) -> None:
        first_look = self.best is None and self._paired
        values = self._candidates.around_kept(self._n_candidates) if first_look else self._values_to_combine()
        tables = self._tables(self._coarse_links if first_look else self._links, values)
        forward = forward_costs(tables)
        chosen = np.empty(self._objective.ranges.count)
        for block, own, index in zip(self._blocks, values, best_chain(tables, forward), strict=True):
            chosen[block] = own[index]
        if first_look:
            choices = np.vstack([chosen, self._seeds])
            self._consider_all(choices, self._full_costs(choices))
        else:
            self._consider(chosen, float(forward[-1].min()))
        for index, (own, through) in enumerate(zip(values, through_costs(tables, forward), strict=True)):
            if len(own) > 1:
                self._candidates.keep(index, own, through, self.best)

    def _tables(self, links: Sequence[Link], values: Sequence[Array]) -> list[Array]:
        """Costs of all pairs of values of neighbouring subgoals, for every stage."""
        return pair_costs(self._chain, links, [np.empty((1, 0)), *values], values)

    def _values_to_combine(self) -> list[Array]:
        """Values of every subgoal in this check, in turns: few of all subgoals, many of every second, of the others."""
        turn = self.checks % TURNS
        if self.best is None or not self._paired or turn == TURNS - 1:
            return self._candidates.around_kept(self._n_candidates)
        drawn = self._candidates.around(self.best, self._n_single)
        return [own if index % 2 == turn % 2 else own[:1] for index, own in enumerate(drawn)]

    def _full_costs(self, choices: Array) -> Array:
        """Cost of whole choices, shape (n, d) -> (n,); as `_objective`, in fewer calls."""
        stages = self._chain.stages
        costs: Array = np.sum(self._chain.costs(stages, [choices[:, stage.columns] for stage in stages]), axis=0)
        return costs
