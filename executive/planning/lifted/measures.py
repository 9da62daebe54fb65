"""Properties and estimates of a lifted plan's flaws, for flaw orders and rankings."""

from __future__ import annotations

from tailor.executive.planning.flaws.ranking import Estimate
from tailor.executive.planning.ground.additive_heuristic import NOTHING, UNREACHABLE, Value, sum_of
from tailor.executive.planning.lifted.achievers import initial_achievers, new_achievers, old_achievers
from tailor.executive.planning.lifted.bindings import Bindings
from tailor.executive.planning.lifted.formula import Equality, LiftedFormula, LiftedLiteral
from tailor.executive.planning.lifted.lifted_plan import LiftedCondition, LiftedPlan, LiftedThreat, effects_of, opposing
from tailor.executive.planning.lifted.task import LiftedTask
from tailor.executive.planning.lifted.threats import count_refinements, separations
from tailor.executive.planning.structures.connectives import Conjunction, Disjunction
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.makespan import makespan_estimate


class LiftedMeasures:
    """See `FlawMeasures` and `PlanEstimates`."""

    def __init__(self, task: LiftedTask) -> None:
        self._task = task

    # --- flaws -----------------------------------------------------------------------------------
    def is_separable(self, plan: LiftedPlan, threat: LiftedThreat) -> bool:
        """See `FlawMeasures`."""
        return any(True for _ in separations(self._task, plan, threat))

    def step(self, condition: LiftedCondition) -> int:
        """See `FlawMeasures`."""
        return self._task.ground.step_of(condition.first)

    def static(self, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`; false for a disjunction."""
        literal = condition.condition
        return isinstance(literal, LiftedLiteral) and literal.predicate in self._task.world.static

    def is_unsafe(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`; false for a disjunction."""
        late, literal = plan.orderings.late[condition.last], condition.condition
        return isinstance(literal, LiftedLiteral) and any(
            node != condition.first and not late >> node & 1 and opposing(literal, effect, plan.bindings)
            for node, _, effect, _ in effects_of(self._task, plan)
        )

    def count_condition_refinements(self, plan: LiftedPlan, condition: LiftedCondition) -> int:
        """See `FlawMeasures`."""
        literal = condition.condition
        if not isinstance(literal, LiftedLiteral):
            return len(literal.parts)
        new = sum(1 for _ in new_achievers(self._task, plan.bindings, literal))
        old = sum(1 for _ in old_achievers(self._task, plan, condition, literal))
        return new + old + sum(1 for _ in initial_achievers(self._task, plan.bindings, literal))

    def count_threat_refinements(self, plan: LiftedPlan, threat: LiftedThreat) -> int:
        """See `FlawMeasures`."""
        return count_refinements(self._task, plan, threat)

    def has_new_achiever(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        literal = condition.condition
        return isinstance(literal, LiftedLiteral) and any(
            True for _ in new_achievers(self._task, plan.bindings, literal)
        )

    def value(self, plan: LiftedPlan, condition: LiftedCondition) -> Value:
        """See `FlawMeasures`."""
        return self._value(condition.condition, plan.bindings)

    def _value(self, formula: LiftedFormula, bindings: Bindings) -> Value:
        match formula:
            case LiftedLiteral(predicate, terms, positive):
                return self._task.value(predicate, positive, tuple(bindings.value(term) for term in terms))
            case Equality(left, right, same):
                possible = bindings.may_equal(left, right) if same else not bindings.same(left, right)
                return NOTHING if possible else UNREACHABLE
            case Conjunction(parts):
                return sum_of(self._value(part, bindings) for part in parts)
            case Disjunction(parts):
                return min((self._value(part, bindings) for part in parts), default=UNREACHABLE)

    def has_old_achiever(self, plan: LiftedPlan, condition: LiftedCondition) -> bool:
        """See `FlawMeasures`."""
        literal = condition.condition
        return isinstance(literal, LiftedLiteral) and any(
            True for _ in old_achievers(self._task, plan, condition, literal)
        )

    # --- rankings --------------------------------------------------------------------------------
    def plain(self, plan: LiftedPlan) -> Estimate:
        """See `PlanEstimates`."""
        total = sum_of(self.value(plan, condition) for condition in cells_of(plan.open))
        return total.cost, total.work

    def reusing(self, plan: LiftedPlan) -> Estimate:
        """See `PlanEstimates`."""
        cost: float = 0
        work: float = 0
        for condition in cells_of(plan.open):
            if self.has_old_achiever(plan, condition):
                work += 1
            else:
                value = self.value(plan, condition)
                cost += value.cost
                work += value.work
        return cost, work

    def makespan(self, plan: LiftedPlan) -> float:
        """See `PlanEstimates`."""
        conditions = [(c.first, self.value(plan, c).makespan) for c in cells_of(plan.open)]
        return makespan_estimate(plan.orderings, conditions)
