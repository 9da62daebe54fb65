"""What a search needs to know of the plans it searches; ground and lifted planning each are one such space."""

from __future__ import annotations

from typing import Protocol, TypeVar

import numpy as np

from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.flaw_selection import FlawSelection
from tailor.executive.planning.flaws.ranking import Rank, Ranking
from tailor.executive.planning.ground.ground_formula import World
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.extraction import extract
from tailor.executive.planning.ground_plans.flaw_measures import GroundFlaws
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.ground_plans.partial_plan import OpenCondition, PartialPlan, initial_plan
from tailor.executive.planning.ground_plans.plan_estimates import GroundEstimates
from tailor.executive.planning.ground_plans.threats import refine_threat
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.settings import Settings, rankings_for
from tailor.executive.planning.structures.refinable import Refinable

P = TypeVar("P", bound=Refinable)


class PlanSpace(Protocol[P]):
    """Partial plans of type P and how they are refined."""

    def initial(self) -> P:
        """The plan that every search starts from."""
        ...

    def complete(self, plan: P) -> bool:
        """Whether a plan without flaws is one that can be executed."""
        ...

    def refine(self, plan: P, order: int) -> list[P]:
        """All ways to mend the flaw that the order-th flaw order chooses."""
        ...

    def rank(self, plan: P, number: int) -> Rank | None:
        """The rank of the `number`-th plan made; None when no solution can come of it."""
        ...

    def extract(self, plan: P) -> Plan:
        """The plan in words."""
        ...


class GroundSpace:
    """The plans of a ground task."""

    def __init__(self, task: GroundTask, world: World, settings: Settings, rng: np.random.Generator) -> None:
        self._task = task
        self._world = world
        names = rankings_for(settings, task.problem.metric)
        self._ranking = Ranking(names, GroundEstimates(task), settings.weight)
        flaws = GroundFlaws(task)
        self._orders = [FlawSelection(parse_flaw_order(order.text), flaws, rng) for order in settings.flaw_orders]
        self.rank = self._ranking.rank

    def initial(self) -> PartialPlan:
        """The goal as open conditions."""
        return initial_plan(self._task)

    def complete(self, plan: PartialPlan) -> bool:
        """Always: no flaw, no doubt."""
        return True

    def refine(self, plan: PartialPlan, order: int) -> list[PartialPlan]:
        """Chooses a flaw and mends it in every way."""
        flaw = self._orders[order].choose(plan)
        if isinstance(flaw, OpenCondition):
            return refine_open(self._task, plan, flaw)
        return refine_threat(self._task, plan, flaw)

    def extract(self, plan: PartialPlan) -> Plan:
        """See `extraction`."""
        return extract(plan, self._task, self._world)
