"""The bound of an anytime search: which partial plans can still become better than the best plan."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from tailor.executive.planning.flaws.ranking import Rank
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.plan_quality import Measure
from tailor.executive.planning.structures.orderings import GOAL
from tailor.executive.planning.structures.refinable import Refinable

if TYPE_CHECKING:
    from tailor.executive.planning.bounds.occupation import Occupation

SLACK, RELATIVE_SLACK = 1e-9, 1e-12  # of sums of costs: the lesser of the two; floats have 16 digits
STEPS_OF_MAKESPAN = 3  # a plan whose makespan is longer by a mean step ranks as one with so many more steps

Ranked = Callable[[Any, int], Rank | None]


class ImprovementBound:
    """Recognises partial plans that can only become as good as the best plan, or worse."""

    def __init__(
        self,
        measure: Measure,
        task: GroundTask,
        value: float,
        occupation: Occupation | None = None,
        mean_step: float = 0.0,
    ) -> None:
        """Takes the first plan's value, and for makespans of ground plans the mean duration of its steps in seconds."""
        self._measure, self._task, self._occupation = measure, task, occupation
        self._unit = self._exact(mean_step) / STEPS_OF_MAKESPAN
        self.lower(value)

    @property
    def is_sharp(self) -> bool:
        """Whether it tells how long the steps of a partial plan take one after the other."""
        return self._unit > 0 and self._occupation is not None and self._occupation.applies

    def lower(self, value: float) -> None:
        """Sets the value of the best plan."""
        slack = min(SLACK, value * RELATIVE_SLACK) if self._measure == "cost" else 0
        self._limit = self._exact(value) - slack

    def is_better(self, value: float) -> bool:
        """Whether a plan of this value is better than the best one."""
        return self._exact(value) < self._limit

    def is_hopeless(self, plan: Refinable) -> bool:
        """Whether all plans below are no better; times and costs only grow as steps are added."""
        match self._measure:
            case "cost":
                return plan.cost >= self._limit
            case "makespan":
                return self._makespan(plan) >= self._limit
            case _:
                return len(plan.steps) >= self._limit

    def ranked_by_makespan(self, rank: Ranked) -> Ranked:
        """The rank, whose first number is a cost in steps, with the least makespan added to it; of a sharp bound."""

        def ranked(plan: Any, number: int) -> Rank | None:
            first = rank(plan, number)
            return None if first is None else (first[0] + self._makespan(plan) / self._unit, *first[1:])

        return ranked

    def _makespan(self, plan: Any) -> float:
        """The least makespan of all plans below, in units of the time grid if actions take time."""
        occupied = self._occupation.bound(plan) if self._occupation is not None else 0
        earliest: float = plan.orderings.earliest()[GOAL]
        return max(earliest, occupied)

    def _exact(self, value: float) -> float:
        """A makespan in whole units of the time grid: durations may differ by a nanosecond."""
        return self._task.grid.units(value) if self._measure == "makespan" and self._task.temporal else value
