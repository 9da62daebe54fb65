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
    """Bounds for n boxes before, of d parameters, and m own ones, of e; without slopes they are constants."""

    middle: Array  # (n, m) seconds in the middle of both boxes, +inf: all values are INVALID
    slopes: tuple[Array, Array] | None = None  # by the parameters before, (n, m, d), and the own ones, (n, m, e)

    def least(self, before: Boxes, own: Boxes, before_tilt: Array, own_tilt: Array) -> Array:
        """Minimum over each pair with tilts, (n, d) and (m, e), that are subtracted and added; shape (n, m)."""
        first, second = (0.0, 0.0) if self.slopes is None else self.slopes
        tilts = (first - before_tilt[:, None]) * before.radius[:, None], (second + own_tilt) * own.radius
        least: Array = self.middle - np.abs(tilts[0]).sum(axis=-1) - np.abs(tilts[1]).sum(axis=-1)
        return least

    def slope(self, side: int, rows: Indices, columns: Indices) -> Array | float:
        """Slopes of some pairs by the parameters before (side 0), (k, d), or the own ones (1), (k, e)."""
        return 0.0 if self.slopes is None else self.slopes[side][rows, columns]

    def of_pieces(self, parents: Indices, moved: Array) -> PairBounds:
        """Bounds of pieces of the own boxes, `moved` from the middle of their parents, (m, e)."""
        middle = self.middle[:, parents]
        if self.slopes is None:
            return PairBounds(middle)
        before, own = (slope[:, parents] for slope in self.slopes)
        return PairBounds(middle + (own * moved).sum(axis=2), (before, own))

    def from_pieces(self, parents: Indices, moved: Array) -> PairBounds:
        """As `of_pieces` for pieces of the boxes before."""
        middle = self.middle[parents]
        if self.slopes is None:
            return PairBounds(middle)
        before, own = (slope[parents] for slope in self.slopes)
        return PairBounds(middle + (before * moved[:, None]).sum(axis=2), (before, own))

    def raise_to(self, bounds: PairBounds, rows: Indices, columns: Indices) -> None:
        """Replace some pairs' bounds by others where these are higher in the middle."""
        block = rows, columns
        higher = bounds.middle >= self.middle[block]
        self.middle[block] = np.where(higher, bounds.middle, self.middle[block])
        for mine, theirs in zip(self.slopes or (), bounds.slopes or (), strict=True):
            mine[block] = np.where(higher[..., None], theirs, mine[block])


def unknown(shape: tuple[int, ...], before: Boxes, own: Boxes, is_linear: bool) -> PairBounds:
    """Bounds of pairs of which nothing is known."""
    middle = np.full(shape, -np.inf)
    if not is_linear:
        return PairBounds(middle)
    return PairBounds(middle, (np.zeros((*shape, before.lower.shape[1])), np.zeros((*shape, own.lower.shape[1]))))
