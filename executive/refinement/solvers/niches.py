"""Searches several niches at once: for asserted subgoals, whose cost has narrow minima far apart.

The first check draws many candidates, also near the places where actions begin and end, and predicts them at exact
arrivals. The best that lie apart found a niche each. Every other check is a (1 + m) evolution strategy in each niche;
from time to time the worse half of the niches is abandoned.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.anchors import Anchor
from tailor.executive.refinement.solvers.chain_structure import StageCost
from tailor.executive.refinement.solvers.solver import Limits, Objective, Solver

N_FAR, N_NEAR = 300, 60  # candidates of the first check in the whole ranges, and near each anchor
NEAR = 0.01  # share of the ranges: standard deviation of candidates around an anchor
MAX_NICHES, MIN_NICHES = 12, 3
MIN_DISTANCE = 0.1  # share of a range between two of them
CHILDREN = 72  # of all niches in one check
PERIOD = 6  # checks after which the worse half is abandoned
MOVED_SHARE = 0.5  # of the parameters of a child
FIRST_STEP, MIN_STEP, MAX_STEP = 0.1, 1e-3, 0.2  # standard deviation, share of the ranges
LONGER, SHORTER = 1.5, 0.8  # after a success, and after a failure
DECADES = -1.5, 0.3  # of a child's own factor of the step


class NicheObjective(Objective, Protocol):
    """Objective with a cheap approximation and known places."""

    @property
    def coarse_stages(self) -> Sequence[StageCost]:
        """Terms of the approximation: they need fewer model inputs."""
        ...

    @property
    def anchors(self) -> Sequence[Anchor]:
        """Places around which candidates are drawn."""
        ...


class NicheSearch(Solver):
    """Evolution strategies in several niches, fewer and fewer."""

    def __init__(self, objective: NicheObjective, rng: np.random.Generator, seeds: Array, limits: Limits) -> None:
        super().__init__(objective, rng, seeds, limits)
        self._coarse = objective
        self._parents = np.empty((0, objective.ranges.count))
        self._costs = np.empty(0)
        self._steps = np.empty(0)
        self._moves = self._parents  # the last success of each niche, or zeros

    def _check(self) -> None:
        if not len(self._parents):
            self._found()
        else:
            self._improve()
            if self.checks % PERIOD == 0:
                self._keep_best(max(MIN_NICHES, len(self._parents) // 2))
        if len(self._parents):
            self._consider_all(self._parents, self._costs)

    def _found(self) -> None:
        """Found niches at the best candidates by the approximation."""
        drawn = np.vstack([self._seeds, self._objective.ranges.draw(N_FAR, self._rng), *self._near_anchors()])
        costs = np.sum([stage.cost(drawn[:, stage.columns]) for stage in self._coarse.coarse_stages], axis=0)
        parents = self._apart(drawn[np.argsort(costs, kind="stable")][: np.isfinite(costs).sum()])
        if not len(parents):
            return  # the next check draws others
        costs = self._objective(parents)
        valid = np.isfinite(costs)
        self._parents, self._costs = parents[valid], costs[valid]
        self._steps, self._moves = np.full(valid.sum(), FIRST_STEP), np.zeros_like(self._parents)
        self._keep_best(MAX_NICHES)

    def _near_anchors(self) -> list[Array]:
        """Candidates around each anchor, whose other parameters are drawn from the whole ranges."""
        ranges, near = self._objective.ranges, []
        for anchor in self._coarse.anchors:
            drawn, columns = ranges.draw(N_NEAR, self._rng), list(anchor.columns)
            off = NEAR * ranges.width[columns] * self._rng.standard_normal((N_NEAR, len(columns)))
            drawn[:, columns] = anchor.values + off
            near.append(ranges.confine(drawn))
        return near

    def _apart(self, ordered: Array) -> Array:
        """The first candidates that lie apart, twice as many as niches: the approximation may mislead."""
        ranges = self._objective.ranges
        chosen: list[Array] = []
        while len(ordered) and len(chosen) < 2 * MAX_NICHES:
            chosen.append(ordered[0])
            distance = np.abs(ordered - ordered[0]) / ranges.width
            distance = np.where(ranges.periodic, np.minimum(distance, 1 - distance), distance)
            ordered = ordered[(distance > MIN_DISTANCE).any(axis=1)]
        return np.array(chosen).reshape(-1, ranges.count)

    def _keep_best(self, count: int) -> None:
        best = np.argsort(self._costs, kind="stable")[:count]
        self._parents, self._costs = self._parents[best], self._costs[best]
        self._steps, self._moves = self._steps[best], self._moves[best]

    def _improve(self) -> None:
        """One generation in each niche."""
        children = self._children()
        costs = self._objective(children.reshape(-1, children.shape[2])).reshape(children.shape[:2])
        niches, best = np.arange(len(children)), costs.argmin(axis=1)
        children, costs = children[niches, best], costs[niches, best]
        better = costs < self._costs
        self._moves = np.where(better[:, None], children - self._parents, 0.0)
        self._parents = np.where(better[:, None], children, self._parents)
        self._costs = np.where(better, costs, self._costs)
        self._steps = np.clip(self._steps * np.where(better, LONGER, SHORTER), MIN_STEP, MAX_STEP)

    def _children(self) -> Array:
        """Children of each niche, shape (niches, m, d): the first repeats the last move, the others are random."""
        rng, ranges = self._rng, self._objective.ranges
        niches, genes = self._parents.shape
        shape = niches, CHILDREN // niches, genes
        moved = rng.random(shape) < MOVED_SHARE
        np.put_along_axis(moved, rng.integers(0, genes, size=(*shape[:2], 1)), True, axis=2)
        scale = 10 ** rng.uniform(*DECADES, (*shape[:2], 1)) * self._steps[:, None, None]
        off = moved * scale * rng.standard_normal(shape) * ranges.width
        off[:, 0] = self._moves
        return ranges.confine((self._parents[:, None] + off).reshape(-1, genes)).reshape(shape)
