"""Detects a proof that makes no more progress: its lower bound hardly rises."""

from __future__ import annotations

import numpy as np

MIN_RISE = 5e-4  # share of the value to be proven
PATIENCE = 4  # iterations without such a rise; proofs that succeeded had no two in a row


class BoundStagnation:
    """Tracks the lower bound of one proof over its iterations."""

    def __init__(self) -> None:
        self._milestone = -np.inf
        self._idle = 0

    def update(self, bound: float, value: float) -> bool:
        """Whether the bound has not risen for too long; called once for each iteration."""
        self._idle += 1
        if bound > self._milestone + MIN_RISE * value:
            self._milestone, self._idle = bound, 0
        return self._idle > PATIENCE
