"""Budgets of deliberation: counted in checks, so that a deadline-bounded computation can be replayed.

Every anytime computation asks `spent()` at fixed points and stops when told; the next tick goes on.
"""

from __future__ import annotations

from typing import Protocol


class Budget(Protocol):
    """What an anytime computation is given."""

    granted: int

    def spent(self) -> bool:
        """Whether to stop now. Each False grants one more unit of work and counts as one check."""
        ...


class CheckBudget:
    """Grants a fixed number of checks; what replay, lock-step and tests use."""

    def __init__(self, checks: int) -> None:
        self.granted = 0
        self._limit = checks

    def spent(self) -> bool:
        """True once `checks` units have been granted."""
        if self.granted >= self._limit:
            return True
        self.granted += 1
        return False
