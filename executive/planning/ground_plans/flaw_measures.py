"""Properties of a ground plan's flaws, for flaw orders."""

from __future__ import annotations

from tailor.executive.planning.ground.additive_heuristic import Value, literals_of
from tailor.executive.planning.ground.ground_action import GroundAction
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.open_conditions import reusable
from tailor.executive.planning.ground_plans.partial_plan import OpenCondition, PartialPlan, Threat
from tailor.executive.planning.ground_plans.threats import count_refinements
from tailor.executive.planning.structures.connectives import Disjunction


class GroundFlawMeasures:
    """See `FlawMeasures`; each part of a compound condition counts as one refinement."""

    def __init__(self, task: GroundTask) -> None:
        self._task = task
        self._first, self._moments = task.first_node, task.moments
        self._restored_of: tuple[GroundAction, ...] = ()
        self._restored_nodes: dict[int, int] = {}
        self.count_threat_refinements = count_refinements

    def is_separable(self, plan: PartialPlan, threat: Threat) -> bool:
        """See `FlawMeasures`; only threats by conditional effects are separable."""
        return bool(threat.conditions)

    def step(self, condition: OpenCondition) -> int:
        """See `FlawMeasures`."""
        return (condition.first - self._first) // self._moments

    def static(self, condition: OpenCondition) -> bool:
        """See `FlawMeasures`; always false, as grounding folds static conditions."""
        return False

    def is_unsafe(self, plan: PartialPlan, condition: OpenCondition) -> bool:
        """See `FlawMeasures`; as for VHPOP 2.2.1, also by a step that restores at once what it deletes."""
        part, earlier = condition.condition, ~plan.orderings.late[condition.last] & ~(1 << condition.first)
        masks, restored = plan.effects.masks(), self._restored(plan.steps)
        if isinstance(part, int):  # nearly all
            return bool((masks[part ^ 1] | restored.get(part ^ 1, 0)) & earlier)
        if isinstance(part, Disjunction):
            return False
        return any((masks[literal ^ 1] | restored.get(literal ^ 1, 0)) & earlier for literal in literals_of(part))

    def _restored(self, steps: tuple[GroundAction, ...]) -> dict[int, int]:
        """By literal the mask of the nodes at which a step makes it true, and false again at once.

        Those of the last steps are kept: a plan may have thousands of conditions.
        """
        if steps is not self._restored_of:
            self._restored_of, self._restored_nodes = steps, {}
            for number, action in enumerate(steps):
                for effect in action.restored:
                    bit = 1 << self._first + number * self._moments + effect.moment
                    self._restored_nodes[effect.literal] = self._restored_nodes.get(effect.literal, 0) | bit
        return self._restored_nodes

    def count_condition_refinements(self, plan: PartialPlan, condition: OpenCondition) -> int:
        """See `FlawMeasures`."""
        literal = condition.condition
        if not isinstance(literal, int):
            return len(literal.parts) if isinstance(literal, Disjunction) else 1
        old = reusable(plan, condition).bit_count()
        return len(self._task.achievers[literal]) + old + (literal in self._task.initial)

    def has_new_achiever(self, plan: PartialPlan, condition: OpenCondition) -> bool:
        """See `FlawMeasures`."""
        return isinstance(condition.condition, int) and bool(self._task.achievers[condition.condition])

    def value(self, plan: PartialPlan, condition: OpenCondition) -> Value:
        """See `FlawMeasures`."""
        return self._task.estimates.of(condition.condition)

    def has_old_achiever(self, plan: PartialPlan, condition: OpenCondition) -> bool:
        """See `FlawMeasures`; as in the estimate with reuse, also one whose own conditions require the literal."""
        literal = condition.condition
        if not isinstance(literal, int):
            return False
        upheld = plan.effects.upheld.get(literal, 0) & ~plan.orderings.late[condition.first]
        return bool(reusable(plan, condition) or upheld)
