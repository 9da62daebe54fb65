"""What flaw orders and rankings ask about lifted plans."""

from __future__ import annotations

from collections.abc import Iterator

from executive.planning.additive_heuristic import Value
from executive.planning.lifted.achieving import initial_achievers, new_achievers, old_achievers
from executive.planning.lifted.lifted_plan import LiftedCondition, LiftedPlan, LiftedThreat, effects_of, opposing
from executive.planning.lifted.resolving import choices, separations
from executive.planning.lifted.task import LiftedTask
from executive.planning.makespan import makespan_estimate
from executive.planning.ranking import Estimate


class LiftedMeasures:
    """See `FlawMeasures` and `PlanEstimates`."""

    def __init__(self, task: LiftedTask) -> None:
        self._task = task

    # --- flaws -----------------------------------------------------------------------------------
    def conditions(self, plan: LiftedPlan) -> Iterator[LiftedCondition]:
        """See `FlawMeasures`."""
        cell = plan.open
        while cell is not None:
            yield cell
            cell = cell.rest

    def threats(self, plan: LiftedPlan) -> Iterator[LiftedThreat]:
        """See `FlawMeasures`."""
        cell = plan.threats
        while cell is not None:
            yield cell
            cell = cell.rest

    def separable(self, plan: LiftedPlan, threat: LiftedThreat) -> bool:
        """See `FlawMeasures`."""
        return any(True for _ in separations(plan, threat))

    def step(self, condition: LiftedCondition) -> int:
        """See `FlawMeasures`."""
        return self._task.step_of(condition.first)

    def static(self, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        return condition.literal.predicate in self._task.world.static

    def unsafe(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        late = plan.orderings.late[condition.last]
        for step in range(1, len(plan.steps) + 1):
            for effect in effects_of(plan, step):
                node = self._task.node_of(step) + effect.moment
                before = node != condition.first and not late >> node & 1
                if before and opposing(condition.literal, effect.literal.of_step(step), plan.bindings):
                    return True
        return False

    def condition_choices(self, plan: LiftedPlan, condition: LiftedCondition) -> int:
        """See `FlawMeasures`."""
        new = sum(1 for _ in new_achievers(self._task, condition.literal))
        old = sum(1 for _ in old_achievers(self._task, plan, condition))
        return new + old + sum(1 for _ in initial_achievers(self._task, plan.bindings, condition.literal))

    def threat_choices(self, plan: LiftedPlan, threat: LiftedThreat) -> int:
        """See `FlawMeasures`."""
        return choices(self._task, plan, threat)

    def by_new_step(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        return any(True for _ in new_achievers(self._task, condition.literal))

    def value(self, plan: LiftedPlan, condition: LiftedCondition) -> Value:
        """See `FlawMeasures`."""
        return self._task.value(condition.literal, plan.bindings)

    def provided(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        return any(True for _ in old_achievers(self._task, plan, condition))

    # --- rankings --------------------------------------------------------------------------------
    def plain(self, plan: LiftedPlan) -> Estimate:
        """See `PlanEstimates`."""
        values = [self.value(plan, condition) for condition in self.conditions(plan)]
        return sum(value.cost for value in values), sum(value.work for value in values)

    def reusing(self, plan: LiftedPlan) -> Estimate:
        """See `PlanEstimates`."""
        cost: float = 0
        work: float = 0
        for condition in self.conditions(plan):
            if self.provided(plan, condition):
                work += 1
            else:
                value = self.value(plan, condition)
                cost += value.cost
                work += value.work
        return cost, work

    def makespan(self, plan: LiftedPlan) -> float:
        """See `PlanEstimates`."""
        conditions = [(c.first, self.value(plan, c).makespan) for c in self.conditions(plan)]
        return makespan_estimate(plan.orderings, conditions)
