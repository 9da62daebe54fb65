"""Deliberation budget that ends at a deadline; it counts granted checks so that a replay can repeat them."""

from __future__ import annotations

from collections.abc import Callable


class ClockBudget:
    """Grants checks until `deadline_ns`; implements tailor.executive.interfaces.budget.Budget."""

    def __init__(self, deadline_ns: int, now_ns: Callable[[], int]) -> None:
        """`deadline_ns` is on the clock of `now_ns`, in nanoseconds."""
        self.granted = 0  # checks so far
        self._deadline_ns = deadline_ns
        self._now_ns = now_ns

    def spent(self) -> bool:
        """True from the deadline on; each False counts as one granted check."""
        if self._now_ns() >= self._deadline_ns:
            self._deadline_ns = -(2**63)  # stays True even if the clock went back
            return True
        self.granted += 1
        return False
