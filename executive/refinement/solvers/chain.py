"""The chain solver: consecutive actions share only the subgoal between them, so the cost is f1(a) + f2(a, b) + ...

One check draws a few candidates for every subgoal, near the best so far and far from it, and finds the best
combination of all of them by dynamic programming: m values at each of s subgoals are m**s chains for s * m**2 rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.solver import Limits, Objective, Solver

Columns = NDArray[np.intp]

FAR_SHARE = 0.125  # of the candidates are drawn from the whole range, so that no valley is missed for ever
DECADES = 3.5  # near ones step by 10**-3.5 to all of the range
N_ELITE = 4  # candidates of a subgoal that survive a check


class StageCost(Protocol):
    """One term of the sum."""

    columns: Columns

    def cost(self, rows: Array) -> Array:
        """The cost, shape (n,), for rows of shape (n, len(columns))."""
        ...


class ChainObjective(Objective, Protocol):
    """An objective that is a sum of stages."""

    @property
    def stages(self) -> Sequence[StageCost]:
        """The terms, in order of execution."""
        ...


@dataclass(frozen=True, slots=True)
class Link:
    """How one stage hangs in the chain: its columns, and where each is found in (block before, own block)."""

    stage: StageCost
    before: Columns  # places in the block before, for the columns that live there
    own: Columns
    from_before: NDArray[np.bool_]  # which of the stage's columns those are, shape (len(columns),)


def blocks_of(stages: Sequence[StageCost]) -> tuple[Columns, ...] | None:
    """The columns of each subgoal, by the stage where they first occur; None when the stages form no chain."""
    first: dict[int, int] = {}
    for index, stage in enumerate(stages):
        for column in stage.columns:
            if index - first.setdefault(int(column), index) > 1:
                return None
    return tuple(
        np.array([column for column, at in sorted(first.items()) if at == index], dtype=np.intp)
        for index in range(len(stages))
    )


class ChainSolver(Solver):
    """Dynamic programming over candidate subgoals, drawn anew at every check around the best chain.

    Args:
      objective: A sum of stages in which no free parameter occurs in stages further apart than neighbours.
      rng: The only source of randomness.
      seeds: Candidates to begin with, shape (s, d).
      batch: Rows that one check may ask of a stage.
      limits: When the search is finished.

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
        self._width = max(N_ELITE + 2, int(np.sqrt(batch)) if paired else batch // 2)
        self._kept = [self._seeds[:, block] for block in blocks]

    def _check(self) -> None:
        drawn = [self._candidates(index) for index in range(len(self._blocks))]
        costs = [
            pairwise_costs(link, before, own)
            for link, before, own in zip(self._links, [np.empty((1, 0)), *drawn], drawn, strict=False)
        ]
        forward = forward_costs(costs)
        candidate = np.empty(self._objective.ranges.count)
        for block, candidates, chosen in zip(self._blocks, drawn, traced(costs, forward), strict=True):
            candidate[block] = candidates[chosen]
        self._consider(candidate, float(forward[-1].min()))
        for index, through in enumerate(through_costs(costs, forward)):
            self._keep(index, drawn[index], through)

    def _keep(self, index: int, drawn: Array, through: Array) -> None:
        """Remember for a subgoal the best value of all and those that the best chains of this check go through."""
        order = np.argsort(through, kind="stable")[:N_ELITE]
        valid = order[np.isfinite(through[order])]
        best = [] if self.best is None else [self.best[self._blocks[index]]]
        if best or len(valid):
            self._kept[index] = np.vstack([*best, drawn[valid]])

    def _candidates(self, index: int) -> Array:
        """Values for one subgoal, shape (m, len(block)): the kept ones, steps from them, and far ones."""
        block, kept = self._blocks[index], self._kept[index]
        if not len(block):
            return np.empty((1, 0))
        ranges = self._objective.ranges.part(block)
        kept = kept[: self._width // 2]
        room = self._width - len(kept)
        far = room if not len(kept) else max(1, round(FAR_SHARE * room))
        near = room - far
        return np.vstack([kept, ranges.draw(far, self._rng), ranges.confine(self._steps(kept, near, ranges.width))])

    def _steps(self, kept: Array, count: int, width: Array) -> Array:
        """Normal steps from the kept values at many scales, half of them along a single parameter."""
        if not count:
            return np.empty((0, len(width)))
        origin = kept[self._rng.integers(0, len(kept), count)]
        scale = 10.0 ** -(DECADES * self._rng.random((count, 1)))
        step = scale * self._rng.standard_normal(origin.shape)
        single = np.arange(len(width)) == self._rng.integers(0, len(width), (count, 1))
        alone = self._rng.random((count, 1)) < 0.5
        return origin + width * np.where(alone & ~single, 0.0, step)


def links_of(stages: Sequence[StageCost], blocks: tuple[Columns, ...]) -> tuple[Link, ...]:
    """How each stage finds its columns in the block before and in its own."""
    links = []
    before: Columns = np.empty(0, dtype=np.intp)
    for stage, own in zip(stages, blocks, strict=True):
        from_before = np.isin(stage.columns, before)
        places_before = np.searchsorted(before, stage.columns[from_before])
        places_own = np.searchsorted(own, stage.columns[~from_before])
        links.append(Link(stage, places_before, places_own, from_before))
        before = own
    return tuple(links)


def pairwise_costs(link: Link, before: Array, own: Array) -> Array:
    """The stage's cost for every pair of values, shape (len(before), len(own)); asks no row twice."""
    first = before[:, link.before] if len(link.before) else np.empty((1, 0))
    second = own[:, link.own] if len(link.own) else np.empty((1, 0))
    rows = np.empty((len(first), len(second), len(link.from_before)))
    rows[:, :, link.from_before] = first[:, None, :]
    rows[:, :, ~link.from_before] = second[None, :, :]
    cost = link.stage.cost(rows.reshape(len(first) * len(second), -1)).reshape(len(first), len(second))
    return np.broadcast_to(cost, (len(before), len(own)))


def forward_costs(costs: list[Array]) -> list[Array]:
    """The least cost from the start to each candidate of each subgoal."""
    least = [costs[0].min(axis=0)]
    for cost in costs[1:]:
        least.append((least[-1][:, None] + cost).min(axis=0))
    return least


def through_costs(costs: list[Array], forward: list[Array]) -> list[Array]:
    """The least cost of a whole chain through each candidate of each subgoal."""
    rest = np.zeros(costs[-1].shape[1])
    through = [forward[-1] + rest]
    for cost, least in zip(costs[:0:-1], forward[-2::-1], strict=True):
        rest = (cost + rest).min(axis=1)
        through.append(least + rest)
    return through[::-1]


def traced(costs: list[Array], forward: list[Array]) -> list[int]:
    """The candidate that the best chain takes at every subgoal, first to last."""
    chain = [int(np.argmin(forward[-1]))]
    for cost, least in zip(costs[:0:-1], forward[-2::-1], strict=True):
        chain.append(int(np.argmin(least + cost[:, chain[-1]])))
    return chain[::-1]
