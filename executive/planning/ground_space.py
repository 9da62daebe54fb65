"""Plan space of a ground task."""

from __future__ import annotations

from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.flaw_selection import FlawSelection
from tailor.executive.planning.flaws.ranking import Ranking
from tailor.executive.planning.ground.ground_formula import StaticWorld
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.extraction import extract, schedule
from tailor.executive.planning.ground_plans.flaw_measures import GroundFlawMeasures
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.ground_plans.partial_plan import OpenCondition, PartialPlan, initial_plan
from tailor.executive.planning.ground_plans.plan_estimates import GroundEstimates
from tailor.executive.planning.ground_plans.separation import UnsettledError
from tailor.executive.planning.ground_plans.threats import refine_threat
from tailor.executive.planning.plan_quality import measure_of
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.results import search_gap
from tailor.executive.planning.settings import Settings, rankings_for
from tailor.executive.planning.structures.random_source import RandomSource


class GroundSpace:
    """See `PlanSpace`."""

    def __init__(self, task: GroundTask, world: StaticWorld, settings: Settings, rng: RandomSource) -> None:
        self._task = task
        self._world = world
        self._unsettled = False  # whether a plan was dropped that may have a schedule,
        self._unshortened = False  # or was given one that may not be its shortest
        names = rankings_for(settings, task.problem.metric)
        self._ranking = Ranking(names, GroundEstimates(task), settings.weight)
        measures = GroundFlawMeasures(task)
        self._orders = [FlawSelection(parse_flaw_order(order.text), measures, rng) for order in settings.flaw_orders]
        self.rank = self._ranking.rank

    def initial(self) -> PartialPlan:
        """See `PlanSpace`: the goal as open conditions."""
        return initial_plan(self._task)

    def is_complete(self, plan: PartialPlan) -> bool:
        """See `PlanSpace`: whether there is a schedule in which no events interfere."""
        try:
            found = schedule(plan, self._task, self._world)
            self._unshortened |= found is not None and not found.is_shortest
            return found is not None
        except UnsettledError:
            self._unsettled = True
            return False

    def gap(self) -> str:
        """See `PlanSpace`."""
        unshortened = self._unshortened and measure_of(self._task.problem) == "makespan"
        return search_gap(self._task.has_alternatives_over_all(), self._unsettled, unshortened)

    def refine(self, plan: PartialPlan, order: int) -> list[PartialPlan]:
        """See `PlanSpace`; a plan without flaws or schedule has no refinements."""
        if plan.open is None and plan.threats is None:
            return []
        flaw = self._orders[order].select(plan)
        if isinstance(flaw, OpenCondition):
            return refine_open(self._task, plan, flaw)
        return refine_threat(self._task, plan, flaw)

    def extract(self, plan: PartialPlan) -> Plan:
        """See `PlanSpace`."""
        return extract(plan, self._task, self._world)
