"""A budget of deliberation that ends by the clock, and counts what it granted so that a replay can repeat it."""

from __future__ import annotations

from collections.abc import Callable


class ClockBudget:
    """Grants work until `deadline_ns`; fits tailor.executive.interfaces.budget.Budget without knowing it."""

    def __init__(self, deadline_ns: int, now_ns: Callable[[], int]) -> None:
        self.granted = 0
        self._deadline_ns = deadline_ns
        self._now_ns = now_ns

    def spent(self) -> bool:
        """True once the deadline has passed, and from then on; each False counts as one check."""
        if self._now_ns() >= self._deadline_ns:
            self._deadline_ns = -(2**63)  # whoever asks again gets the same answer, whatever the clock does
            return True
        self.granted += 1
        return False
