"""Lower bounds of an action's cost for pairs of boxes, linear in the parameters of the subgoals before and after it.

A subgoal that makes one action shorter often makes the next one longer. So a linear term, its tilt, is added to the
cost of the action that leads to a box and subtracted from that of the next one: no chain costs more or less, but the
bounds of the two actions no longer assume different places in the box.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.certificates.boxes import Boxes

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class PairBounds:
    """Bounds for n boxes before, of d parameters, and m own ones, of e parameters."""

    middle: Array  # (n, m) seconds in the middle of both boxes, +inf: all values are INVALID
    before: Array  # (n, m, d) seconds a unit
    own: Array  # (n, m, e)

    def least(self, before: Boxes, own: Boxes, before_tilt: Array, own_tilt: Array) -> Array:
        """Minimum over each pair with tilts, (n, d) and (m, e), that are subtracted and added; shape (n, m)."""
        least = self.middle
        for k in range(before_tilt.shape[1]):
            least = least - np.abs(self.before[:, :, k] - before_tilt[:, None, k]) * before.radius[:, None, k]
        for k in range(own_tilt.shape[1]):
            least = least - np.abs(self.own[:, :, k] + own_tilt[:, k]) * own.radius[:, k]
        return least

    def of_pieces(self, parents: Indices, moved: Array) -> PairBounds:
        """Bounds of pieces of the own boxes, `moved` from the middle of their parents, (m, e)."""
        own = self.own[:, parents]
        return PairBounds(self.middle[:, parents] + (own * moved).sum(axis=2), self.before[:, parents], own)

    def from_pieces(self, parents: Indices, moved: Array) -> PairBounds:
        """As `of_pieces` for pieces of the boxes before."""
        before = self.before[parents]
        return PairBounds(self.middle[parents] + (before * moved[:, None]).sum(axis=2), before, self.own[parents])

    def raise_to(self, bounds: PairBounds, rows: Indices, columns: Indices) -> None:
        """Replace some pairs' bounds by others where these are higher in the middle."""
        block = rows, columns
        higher = bounds.middle >= self.middle[block]
        for mine, theirs in ((self.middle, bounds.middle), (self.before, bounds.before), (self.own, bounds.own)):
            mine[block] = np.where(higher.reshape(*higher.shape, *(1,) * (mine.ndim - 2)), theirs, mine[block])


def unknown(shape: tuple[int, ...], before: Boxes, own: Boxes) -> PairBounds:
    """Bounds of pairs of which nothing is known."""
    slopes = (np.zeros((*shape, boxes.lower.shape[1])) for boxes in (before, own))
    return PairBounds(np.full(shape, -np.inf), *slopes)
