"""A growth curve: what something costs as the work grows, and how fast it grows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

TOLERANCE = 0.25  # of an exponent, which is measured
LAST = 4  # points that an exponent is fitted to: small work costs its overhead


@dataclass(frozen=True, slots=True)
class Curve:
    """Measured points of one curve.

    Attributes:
      name: What was measured.
      work: What grows, with its unit.
      cost: What it costs, with its unit.
      points: (work, cost) in order of work; both > 0.
      allowed: The highest exponent that is no defect: 0 flat, 1 in proportion, 2 with the square.
    """

    name: str
    work: str
    cost: str
    points: Sequence[tuple[float, float]]
    allowed: float

    @property
    def exponent(self) -> float:
        """Slope of the last points in a plot with logarithmic axes, by least squares; not a number below two points."""
        last = np.log(np.array(self.points[-LAST:]))
        return float(np.polyfit(last[:, 0], last[:, 1], 1)[0]) if len(last) > 1 else float("nan")

    @property
    def too_fast(self) -> bool:
        """Whether it grows faster than it should."""
        return self.exponent > self.allowed + TOLERANCE

    def fields(self) -> Mapping[str, Any]:
        """JSON values."""
        return {
            "name": self.name,
            "work": self.work,
            "cost": self.cost,
            "points": [[float(work), float(cost)] for work, cost in self.points],
            "exponent": None if math.isnan(self.exponent) else round(self.exponent, 2),
            "allowed": self.allowed,
            "too_fast": self.too_fast,
        }
