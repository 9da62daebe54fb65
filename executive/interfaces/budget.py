"""Budgets of deliberation, counted in checks so that a deadline-bounded computation can be replayed.

Every anytime computation calls `spent()` at fixed points and returns when it is True; the next tick resumes it.
"""

from __future__ import annotations

from typing import Protocol


class Budget(Protocol):
    """Budget of one tick's deliberation.

    Attributes:
      granted: Number of checks granted so far.
    """

    granted: int

    def spent(self) -> bool:
        """Whether the computation must return now. Each False grants one more unit of work and counts as one check."""
        ...


class CheckBudget:
    """Grants a fixed number of checks; used by replay, lock-step and tests."""

    def __init__(self, checks: int) -> None:
        """Create a budget.

        Args:
          checks: Number of checks to grant; 0 grants none.
        """
        self.granted = 0
        self._limit = checks

    def spent(self) -> bool:
        """True once `checks` units have been granted."""
        if self.granted >= self._limit:
            return True
        self.granted += 1
        return False
