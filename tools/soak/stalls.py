"""Stalls of the machine: how late this process wakes from its own short sleeps."""

from __future__ import annotations

import time

LATE_S = 0.01  # ordinary
KEPT_S = 60.0


class Stalls:
    """Sleeps, and remembers how late it woke.

    Attributes:
      worst_s: Longest stall so far.
    """

    def __init__(self) -> None:
        self.worst_s = 0.0
        self._late: list[tuple[float, float]] = []  # time, lateness

    def sleep(self, seconds: float) -> None:
        """Sleep; what comes on top is a stall."""
        due_s = time.monotonic() + seconds
        time.sleep(seconds)
        now_s = time.monotonic()
        late_s = now_s - due_s
        if late_s > LATE_S:
            self._late = [each for each in self._late if each[0] > now_s - KEPT_S] + [(now_s, late_s)]
            self.worst_s = max(self.worst_s, late_s)

    def worst_since(self, since_s: float) -> float:
        """Longest stall after a monotonic time, within the last minute."""
        return max((late_s for at_s, late_s in self._late if at_s > since_s), default=0.0)
