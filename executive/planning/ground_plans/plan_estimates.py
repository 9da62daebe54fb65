"""Additive estimates of the open conditions of a ground plan."""

from __future__ import annotations

from tailor.executive.planning.flaws.ranking import Estimate
from tailor.executive.planning.ground.additive_heuristic import sum_of
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.partial_plan import PartialPlan
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.makespan import makespan_estimate


class GroundEstimates:
    """See `PlanEstimates`."""

    def __init__(self, task: GroundTask) -> None:
        self._task = task
        self._costs, self._works = task.estimates.cost, task.estimates.work

    def plain(self, plan: PartialPlan) -> Estimate:
        """See `PlanEstimates`."""
        total = sum_of(self._task.estimates.of(cell.condition) for cell in cells_of(plan.open))
        return total.cost, total.work

    def reusing(self, plan: PartialPlan) -> Estimate:
        """See `PlanEstimates`; without calls, as it is the planner's hottest loop.

        As for VHPOP 2.2.1, an effect that its action's own conditions require can be reused as well.
        """
        costs, works = self._costs, self._works
        late, effects = plan.orderings.late, plan.effects
        base, bits, node, upheld = effects.base, effects.bits, effects.node, effects.upheld
        cost: float = 0
        work: float = 0
        cell = plan.open
        while cell is not None:
            condition, first, _, cell = cell
            if condition.__class__ is int:  # faster than isinstance
                mask = base[condition]
                if bits is not None and condition in bits:
                    mask |= bits[condition] << node
                if upheld and condition in upheld:
                    mask |= upheld[condition]
                if mask & ~late[first]:
                    work += 1
                else:
                    cost += costs[condition]
                    work += works[condition]
            else:
                value = self._task.estimates.of(condition)
                cost += value.cost
                work += value.work
        return cost, work

    def makespan(self, plan: PartialPlan) -> float:
        """See `PlanEstimates`."""
        conditions = [(cell.first, self._task.estimates.of(cell.condition).makespan) for cell in cells_of(plan.open)]
        return makespan_estimate(plan.orderings, conditions)
