"""Work in portions: a generator that yields after each small portion and returns its result.

So the executive can spread the treatment of a long plan over several ticks. A portion treats one step of a plan, or an
equal amount of work.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Generic, TypeVar

from tailor.executive.interfaces.budget import Budget

Result = TypeVar("Result")
Work = Generator[None, None, Result]
PORTIONS = 32  # for each check; about 1 ms
FREE_PORTIONS = 64  # before the first check: short plans cost no checks


def completed_work(work: Work[Result]) -> Result:
    """Runs all portions at once.

    Args:
      work: Work that nobody else advances.

    Returns:
      Its result.
    """
    while True:
        try:
            next(work)
        except StopIteration as end:
            result: Result = end.value
            return result


class PacedWork(Generic[Result]):
    """Work that is advanced from tick to tick; deterministic in the number of granted checks."""

    def __init__(self, work: Work[Result], free_portions: int = FREE_PORTIONS) -> None:
        """Store the work, of which so many portions are free; nothing is done before `advance`."""
        self._work = work
        self._left = free_portions
        self._result: list[Result] = []

    def advance(self, budget: Budget) -> bool:
        """Continue until the work is finished (True) or the budget is spent (False)."""
        while not self._result:
            if not self._left:
                if budget.spent():
                    return False
                self._left = PORTIONS
            self._left -= 1
            self._do_portion()
        return True

    def rest(self) -> Work[Result]:
        """The rest of the work, as part of other work."""
        while not self._result:
            self._do_portion()
            yield
        return self._result[0]

    @property
    def result(self) -> Result:
        """The result of finished work."""
        return self._result[0]

    def _do_portion(self) -> None:
        try:
            next(self._work)
        except StopIteration as end:
            self._result.append(end.value)
