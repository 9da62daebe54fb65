"""The analytic optimum of model trees (paper 6.2.1): dynamic programming over the grid that their edges span.

Where the cost is affine between edges, the least of all grid points is the global minimum, up to the width of a nudge.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.chain import ChainObjective, blocks_of, links_of, pairwise_costs, traced
from tailor.executive.refinement.solvers.solver import Limits, Solver

GRID_MAX = 20_000  # points of one subgoal's grid
ROWS_AT_ONCE = 50_000  # keeps the memory of one model call small


class AnalyticSolver(Solver):
    """One action of the chain a check; finished after the last one.

    Args:
      objective: A sum of stages that form a chain.
      points: For each free parameter its edges, see `breakpoints`.

    Raises:
      ValueError: The stages form no chain, or a grid is larger than GRID_MAX points.
    """

    def __init__(self, objective: ChainObjective, points: tuple[Array, ...]) -> None:
        blocks = blocks_of(objective.stages)
        if blocks is None:
            raise ValueError("a parameter occurs in actions that are not neighbours: not a chain")
        count = len(objective.stages)
        super().__init__(objective, np.random.default_rng(0), np.empty((0, len(points))), Limits(count, count))
        sizes = [int(np.prod([len(points[column]) for column in block])) for block in blocks]
        if max(sizes) > GRID_MAX:
            raise ValueError(f"a subgoal has {max(sizes)} grid points, expected at most {GRID_MAX}")
        self._blocks = blocks
        self._links = links_of(objective.stages, blocks)
        self._grids = [np.array(list(product(*(points[column] for column in block)))) for block in blocks]
        self._grids = [grid.reshape(max(1, len(grid)), len(b)) for grid, b in zip(self._grids, blocks, strict=True)]
        self._costs: list[Array] = []
        self._forward: list[Array] = []

    def _check(self) -> None:
        index = len(self._costs)
        before = self._grids[index - 1] if index else np.empty((1, 0))
        own = self._grids[index]
        parts = np.array_split(before, -(-len(before) * len(own) // ROWS_AT_ONCE))
        cost = np.vstack([pairwise_costs(self._links[index], part, own) for part in parts])
        least = self._forward[-1] if index else np.zeros(1)
        self._costs.append(cost)
        self._forward.append((least[:, None] + cost).min(axis=0))
        if index + 1 == len(self._links):
            candidate = np.empty(self._objective.ranges.count)
            for block, grid, chosen in zip(self._blocks, self._grids, traced(self._costs, self._forward), strict=True):
                candidate[block] = grid[chosen]
            self._consider(candidate, float(self._forward[-1].min()))
