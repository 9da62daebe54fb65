"""Candidate values of all subgoals of a chain: kept ones, ones from the whole range, and steps from the kept ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.solvers.chain_structure import Columns
from tailor.executive.refinement.solvers.random_scales import random_scales

FAR_SHARE = 0.25  # of the candidates are drawn from the whole range, so that every basin is sampled eventually
DECADES = 3.5  # near candidates step by 10**-3.5 to all of the range
N_ELITE = 6  # candidates of a subgoal that survive a check, beside the best
MIN_DISTANCE = 0.03  # share of a range between two of them


class Candidates:
    """Candidate values of s subgoals with d parameters together.

    Args:
      ranges: Of the d parameters.
      blocks: Columns of each subgoal; a subgoal may have none.
      rng: The only source of randomness.
      kept: Initial values, shape (n, d).
    """

    def __init__(self, ranges: Ranges, blocks: Sequence[Columns], rng: np.random.Generator, kept: Array) -> None:
        self._ranges = ranges
        self._blocks = blocks
        self._rng = rng
        self._kept = [kept[:, block] for block in blocks]
        sizes = np.array([len(block) for block in blocks])
        self._block_of = np.empty(ranges.count, np.intp)
        self._place: NDArray[np.intp] = np.empty(ranges.count, np.intp)  # of a column in its block
        for index, block in enumerate(blocks):
            self._block_of[block], self._place[block] = index, np.arange(sizes[index])
        self._sizes = sizes

    def around_kept(self, count: int) -> list[Array]:
        """Values of each subgoal, shape (about `count`, q): first the kept ones."""
        return self._drawn(count, self._kept)

    def around(self, choice: Array, count: int) -> list[Array]:
        """As `around_kept` for the values of one choice, shape (d,)."""
        return self._drawn(count, [choice[None, block] for block in self._blocks])

    def keep(self, index: int, drawn: Array, through: Array, best: Array | None) -> None:
        """Keep the best value of a subgoal, and values on the best chains that lie apart.

        Args:
          index: Of the subgoal.
          drawn: Its values, shape (n, q).
          through: Cost of the best chain through each, shape (n,).
          best: The best choice so far, shape (d,); None if there is none.
        """
        order = np.argsort(through, kind="stable")
        ordered = drawn[order[np.isfinite(through[order])]]
        block = self._blocks[index]
        if best is not None:
            ordered = np.vstack([best[block], ordered])
        apart = MIN_DISTANCE * self._ranges.width[block]
        chosen: list[Array] = []
        while len(ordered) and len(chosen) <= N_ELITE:
            chosen.append(ordered[0])
            ordered = ordered[(np.abs(ordered - ordered[0]) > apart).any(axis=1)]
        if chosen:
            self._kept[index] = np.array(chosen)

    def _drawn(self, count: int, kept: Sequence[Array]) -> list[Array]:
        kept = [values[: count // 2] for values in kept]
        numbers = [len(values) for values, block in zip(kept, self._blocks, strict=True) if len(block)]
        n_new = count - max(numbers, default=0)
        n_far = max(1, round(FAR_SHARE * n_new)) if all(numbers) else n_new
        far = self._ranges.draw(n_far, self._rng)
        near = self._steps(kept, n_new - n_far)
        return [
            np.vstack([values, far[:, block], near[:, block]]) if len(block) else np.empty((1, 0))
            for values, block in zip(kept, self._blocks, strict=True)
        ]

    def _steps(self, kept: Sequence[Array], count: int) -> Array:
        """Normal steps from kept values at many scales, half of them along a single parameter; shape (count, d)."""
        rng, of = self._rng, self._block_of
        origin = np.empty((count, self._ranges.count))
        if not count:
            return origin
        for block, values, number in zip(self._blocks, kept, rng.random((len(kept), count)), strict=True):
            if len(block):
                origin[:, block] = values[(number * len(values)).astype(np.intp)]
        each = count, len(kept)
        scale = random_scales(DECADES, rng, each)
        axis = (rng.random(each) * self._sizes).astype(np.intp)
        along_axis = rng.random(each) < 0.5
        step = scale[:, of] * rng.standard_normal(origin.shape)
        step[along_axis[:, of] & (axis[:, of] != self._place)] = 0.0
        return self._ranges.confine(origin + self._ranges.width * step)
