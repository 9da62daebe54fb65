"""Tells when a proof has stopped getting anywhere: its bound hardly rises any more."""

from __future__ import annotations

import numpy as np

WORTH = 5e-4  # of the value that is to be proven: a rise
PATIENCE = 4  # turns without one; proofs that got there had no two in a row


class BoundStagnation:
    """Watches the bound of one proof from turn to turn."""

    def __init__(self) -> None:
        self._milestone = -np.inf
        self._idle = 0

    def stalls(self, bound: float, value: float) -> bool:
        """Whether the bound has not risen for too long; called once a turn."""
        self._idle += 1
        if bound > self._milestone + WORTH * value:
            self._milestone, self._idle = bound, 0
        return self._idle > PATIENCE
