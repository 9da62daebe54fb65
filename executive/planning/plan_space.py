"""Plan spaces as both search algorithms use them, and what the ground and the lifted one share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.flaw_selection import FlawMeasures, FlawSelection
from tailor.executive.planning.flaws.ranking import PlanEstimates, Rank, Ranking
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.plan_quality import measure_of
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.settings import Settings, rankings_for
from tailor.executive.planning.structures.random_source import RandomSource
from tailor.executive.planning.structures.refinable import Refinable

P = TypeVar("P", bound=Refinable)


class PlanSpace(ABC, Generic[P]):
    """Partial plans of type P and their refinements."""

    def __init__(
        self,
        task: GroundTask,
        settings: Settings,
        measures: FlawMeasures[P, Any, Any],
        estimates: PlanEstimates[P],
        rng: RandomSource,
    ) -> None:
        self._ground = task
        self._unsettled = False  # whether a plan was dropped that may have a schedule,
        self._unshortened = False  # or was given one that may not be its shortest
        self._orders = [FlawSelection(parse_flaw_order(order.text), measures, rng) for order in settings.flaw_orders]
        names = rankings_for(settings, task.problem.metric)
        # the rank of the n-th plan generated; None if no solution is below it
        self.rank: Callable[[P, int], Rank | None] = Ranking(names, estimates, settings.weight).rank

    @abstractmethod
    def initial(self) -> P:
        """The root of the search: a plan without steps, the goal as open conditions."""

    @abstractmethod
    def is_complete(self, plan: P) -> bool:
        """Whether a plan without flaws can be executed: it has a schedule in which no events interfere."""

    @abstractmethod
    def extract(self, plan: P) -> Plan:
        """The finished plan, with actions and links by name."""

    def refine(self, plan: P, order: int) -> list[P]:
        """All resolvers of the flaw that the order-th flaw order selects; none of a plan without flaws."""
        if plan.open is None and plan.threats is None:
            return []
        return self._resolvers(plan, self._orders[order].select(plan))

    @abstractmethod
    def _resolvers(self, plan: P, flaw: Any) -> list[P]:
        """All resolvers of a flaw."""

    def gap(self) -> str:
        """Why a space without solutions is no proof that there is none; "" if it is: every plan is below the root."""
        if self._ground.has_alternatives_over_all():
            return "the search is exhausted, but of a condition over all with alternatives it keeps to one throughout"
        if self._unsettled:
            return "the search is exhausted, but for some plan it gave up to look for a schedule without interference"
        if self._unshortened and measure_of(self._ground.problem) == "makespan":
            return "the search is exhausted, but some plan may have a shorter schedule"
        return ""
