"""Plan space of a ground task."""

from __future__ import annotations

from tailor.executive.planning.ground.ground_formula import StaticWorld
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.extraction import extract, schedule
from tailor.executive.planning.ground_plans.flaw_measures import GroundFlawMeasures
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.ground_plans.partial_plan import Flaw, OpenCondition, PartialPlan, initial_plan
from tailor.executive.planning.ground_plans.plan_estimates import GroundEstimates
from tailor.executive.planning.ground_plans.separation import UnsettledError
from tailor.executive.planning.ground_plans.threats import refine_threat
from tailor.executive.planning.plan_space import PlanSpace
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.settings import Settings
from tailor.executive.planning.structures.random_source import RandomSource


class GroundSpace(PlanSpace[PartialPlan]):
    """See `PlanSpace`."""

    def __init__(self, task: GroundTask, world: StaticWorld, settings: Settings, rng: RandomSource) -> None:
        super().__init__(task, settings, GroundFlawMeasures(task), GroundEstimates(task), rng)
        self._world = world

    def initial(self) -> PartialPlan:
        """See `PlanSpace`."""
        return initial_plan(self._ground)

    def is_complete(self, plan: PartialPlan) -> bool:
        """See `PlanSpace`."""
        try:
            found = schedule(plan, self._ground, self._world)
        except UnsettledError:
            self._unsettled = True
            return False
        self._unshortened |= found is not None and not found.is_shortest
        return found is not None

    def extract(self, plan: PartialPlan) -> Plan:
        """See `PlanSpace`."""
        return extract(plan, self._ground, self._world)

    def _resolvers(self, plan: PartialPlan, flaw: Flaw) -> list[PartialPlan]:
        if isinstance(flaw, OpenCondition):
            return refine_open(self._ground, plan, flaw)
        return refine_threat(self._ground, plan, flaw)
