"""A layer of rectifiers between two lines each: the lines depend on the range of a rectifier's input."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]


class Rectified:
    """Lines below and above max(x, 0) for inputs between `lower` and `upper`, (k, h, n).

    The line above has the slope `above` and passes `offset` over 0; that below passes 0, with slope 0 or 1.
    """

    def __init__(self, lower: Floats, upper: Floats) -> None:
        self.lower = lower
        low, self.high = np.minimum(lower, 0), np.maximum(upper, 0)
        self.above = self.high / np.maximum(self.high - low, np.float32(1e-12))
        self.offset = -self.above * low
        self._steep = self.high > -low

    def below(self, factor: Floats) -> tuple[Floats, Floats]:
        """Lower bound of `factor` times the outputs: factors of the inputs, and the sum of all offsets, (n,)."""
        negative = np.minimum(factor, 0)
        offset: Floats = (negative * self.offset).sum(axis=(0, 1))
        return np.maximum(factor, 0) * self._steep + negative * self.above, offset
