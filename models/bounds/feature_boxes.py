"""Boxes of features, some of which vary together along a curve: ranges of linear functions over them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Ends = tuple[Floats, Floats]


@dataclass(frozen=True, slots=True)
class FeatureBoxes:
    """n boxes of f features; the last g vary along a curve with v corners, the m others by themselves.

    Attributes:
      middle: Of each feature, (f, n).
      radius: Of those that vary by themselves, (m, n).
      corners: Of the others, relative to their middle, (g, v, n); g may be 0.
    """

    middle: Floats
    radius: Floats
    corners: Floats

    def part(self, boxes: slice | NDArray[np.intp]) -> FeatureBoxes:
        """Some of the boxes."""
        return FeatureBoxes(self.middle[:, boxes], self.radius[:, boxes], self.corners[:, :, boxes])

    def ends(self, middle: Floats, weights: Floats) -> Ends:
        """Both ends of `middle` plus the weights, (k, out, f), times the features' distance from their middle."""
        apart = len(self.radius)
        reach = np.abs(weights[:, :, :apart]) @ self.radius
        if not len(self.corners):
            return middle - reach, middle + reach
        bend = weights[:, :, apart:] @ self.corners.reshape(len(self.corners), -1)
        return self._beside(middle, reach, bend.reshape(*middle.shape[:2], -1, middle.shape[2]))

    def ends_of_slopes(self, middle: Floats, reach: Floats, slopes: list[Floats]) -> Ends:
        """As `ends`, with a further reach, for slopes of each feature that differ by box, (k, out, n)."""
        apart = len(self.radius)
        reach = reach + sum(np.abs(slope) * radius for slope, radius in zip(slopes, self.radius, strict=False))
        if not len(self.corners):
            return middle - reach, middle + reach
        bend = sum(slope[:, :, None] * corner for slope, corner in zip(slopes[apart:], self.corners, strict=True))
        return self._beside(middle, reach, np.asarray(bend))

    @staticmethod
    def _beside(middle: Floats, reach: Floats, bend: Floats) -> Ends:
        """Ends with a reach to both sides and the values at the corners, (k, out, v, n)."""
        return middle - reach + bend.min(axis=2), middle + reach + bend.max(axis=2)


def boxes_between(lower: Floats, upper: Floats, curve: Floats | None = None) -> FeatureBoxes:
    """Boxes between ends, (m, n), and, with a curve, further features at its corners, (g, v, n)."""
    half = np.float32(0.5)
    middle, radius = half * (lower + upper), half * (upper - lower)
    if curve is None:
        return FeatureBoxes(middle, radius, np.empty((0, 1, lower.shape[1]), np.float32))
    centre = half * (curve.min(axis=1) + curve.max(axis=1))
    return FeatureBoxes(np.vstack([middle, centre]), radius, curve - centre[:, None])
