"""Chain structure of an objective: consecutive actions share only the subgoal between them.

The cost is a sum f1(a) + f2(a, b) + f3(b, c) + ..., so dynamic programming finds the best combination of candidates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.solvers.solver import Objective

Columns = NDArray[np.intp]


class StageCost(Protocol):
    """One term of the sum."""

    columns: Columns

    def cost(self, samples: Array) -> Array:
        """Cost, shape (n,), for samples of shape (n, len(columns))."""
        ...


class ChainObjective(Objective, Protocol):
    """Objective that is a sum of stages."""

    @property
    def stages(self) -> Sequence[StageCost]:
        """The terms, in order of execution."""
        ...

    @property
    def coarse_stages(self) -> Sequence[StageCost]:
        """Approximations of the terms that need fewer model inputs."""
        ...

    def costs(self, stages: Sequence[Any], samples: Sequence[Array]) -> list[Array]:
        """Cost of each of the stages for its own samples."""
        ...


@dataclass(frozen=True, slots=True)
class Link:
    """Position of one stage in the chain: indices of its columns in the block before and in its own block."""

    stage: StageCost
    before: Columns  # indices in the block before, for the columns of that block
    own: Columns
    from_before: NDArray[np.bool_]  # mask of the stage's columns in the block before, shape (len(columns),)


def blocks_of(stages: Sequence[StageCost]) -> tuple[Columns, ...] | None:
    """Columns of each subgoal, by the stage where they first occur; None if the stages form no chain."""
    first: dict[int, int] = {}
    for index, stage in enumerate(stages):
        for column in stage.columns:
            if index - first.setdefault(int(column), index) > 1:
                return None
    return tuple(
        np.array([column for column, at in sorted(first.items()) if at == index], dtype=np.intp)
        for index in range(len(stages))
    )


def links_of(stages: Sequence[StageCost], blocks: tuple[Columns, ...]) -> tuple[Link, ...]:
    """Position of each stage in the chain of blocks."""
    links = []
    before: Columns = np.empty(0, dtype=np.intp)
    for stage, own in zip(stages, blocks, strict=True):
        from_before = np.isin(stage.columns, before)
        indices_before = np.searchsorted(before, stage.columns[from_before])
        indices_own = np.searchsorted(own, stage.columns[~from_before])
        links.append(Link(stage, indices_before, indices_own, from_before))
        before = own
    return tuple(links)


def pair_costs(
    objective: ChainObjective, links: Sequence[Link], before: Sequence[Array], own: Sequence[Array]
) -> list[Array]:
    """Cost of each stage for every pair of values, shape (len(before[i]), len(own[i])); each is predicted once."""
    samples = [_pairs(*each) for each in zip(links, before, own, strict=False)]
    rows = [each.reshape(each.shape[0] * each.shape[1], each.shape[2]) for each in samples]
    costs = objective.costs([link.stage for link in links], rows)
    return [
        np.broadcast_to(cost.reshape(each.shape[:2]), (len(first), len(second)))
        for cost, each, first, second in zip(costs, samples, before, own, strict=False)
    ]


def _pairs(link: Link, before: Array, own: Array) -> Array:
    """Samples of a stage, shape (m, n, len(columns)); a side that it does not depend on has one row."""
    first = before[:, link.before] if len(link.before) else np.empty((1, 0))
    second = own[:, link.own] if len(link.own) else np.empty((1, 0))
    samples = np.empty((len(first), len(second), len(link.from_before)))
    samples[:, :, link.from_before] = first[:, None, :]
    samples[:, :, ~link.from_before] = second[None, :, :]
    return samples


def forward_costs(costs: list[Array]) -> list[Array]:
    """Minimum cost from the start to each candidate of each subgoal."""
    least = [costs[0].min(axis=0)]
    for cost in costs[1:]:
        least.append((least[-1][:, None] + cost).min(axis=0))
    return least


def through_costs(costs: list[Array], forward: list[Array]) -> list[Array]:
    """Minimum cost of a whole chain through each candidate of each subgoal."""
    rest = np.zeros(costs[-1].shape[1])
    through = [forward[-1] + rest]
    for cost, least in zip(costs[:0:-1], forward[-2::-1], strict=True):
        rest = (cost + rest).min(axis=1)
        through.append(least + rest)
    return through[::-1]


def best_chain(costs: list[Array], forward: list[Array]) -> list[int]:
    """Index of the best chain's candidate at every subgoal, first to last."""
    chain = [int(np.argmin(forward[-1]))]
    for cost, least in zip(costs[:0:-1], forward[-2::-1], strict=True):
        chain.append(int(np.argmin(least + cost[:, chain[-1]])))
    return chain[::-1]
