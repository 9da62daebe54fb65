"""Plan space of a lifted task."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.flaw_selection import FlawSelection
from tailor.executive.planning.flaws.ranking import Ranking
from tailor.executive.planning.ground_plans.extraction import Frame, scheduled
from tailor.executive.planning.ground_plans.separation import UnsettledError, makespan
from tailor.executive.planning.lifted.bindings import Bindings
from tailor.executive.planning.lifted.formula import LiftedLiteral
from tailor.executive.planning.lifted.lifted_plan import LiftedCondition, LiftedPlan, initial_plan
from tailor.executive.planning.lifted.measures import LiftedMeasures
from tailor.executive.planning.lifted.open_conditions import refine_condition
from tailor.executive.planning.lifted.task import LiftedTask
from tailor.executive.planning.lifted.threats import refine_threat
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.plan_quality import measure_of
from tailor.executive.planning.plans.plan import Link, Plan
from tailor.executive.planning.results import search_gap
from tailor.executive.planning.settings import Settings, rankings_for
from tailor.executive.planning.structures.orderings import Orderings
from tailor.executive.planning.structures.random_source import RandomSource

MAX_COMPLETIONS = 10  # tried for a schedule; nearly always the first one has one


class LiftedSpace:
    """See `PlanSpace`."""

    def __init__(self, task: LiftedTask, settings: Settings, rng: RandomSource) -> None:
        measures = LiftedMeasures(task)
        self._task = task
        self._unsettled = False  # whether a plan was dropped that may have a schedule,
        self._unshortened = False  # or was given one that may not be its shortest
        self._ranking = Ranking(rankings_for(settings, task.ground.problem.metric), measures, settings.weight)
        self._orders = [FlawSelection(parse_flaw_order(order.text), measures, rng) for order in settings.flaw_orders]
        self.rank = self._ranking.rank

    def initial(self) -> LiftedPlan:
        """See `PlanSpace`: the goal as open conditions."""
        return initial_plan(self._task)

    def is_complete(self, plan: LiftedPlan) -> bool:
        """See `PlanSpace`: whether there is an object for every variable, and a schedule without interference."""
        return self._completion(plan) is not None

    def gap(self) -> str:
        """See `PlanSpace`."""
        ground = self._task.ground
        unshortened = self._unshortened and measure_of(ground.problem) == "makespan"
        return search_gap(ground.has_alternatives_over_all(), self._unsettled, unshortened)

    def refine(self, plan: LiftedPlan, order: int) -> list[LiftedPlan]:
        """See `PlanSpace`; a plan without flaws whose bindings cannot be completed has no refinements."""
        if plan.open is None and plan.threats is None:
            return []
        flaw = self._orders[order].select(plan)
        if isinstance(flaw, LiftedCondition):
            return refine_condition(self._task, plan, flaw)
        return refine_threat(self._task, plan, flaw)

    def extract(self, plan: LiftedPlan) -> Plan:
        """See `PlanSpace`; the bindings are lines as VHPOP prints them."""
        task, completion = self._task, self._completion(plan)
        assert completion is not None
        bindings, orderings = completion
        names = _names(plan, bindings)
        frame = Frame(names, orderings, task.first_node, task.moments, task.ground.grid)
        order = {step.id: n for n, step in enumerate(frame.steps())}
        links = sorted(self._links(plan, bindings), key=lambda link: order.get(link.consumer, len(order)))
        return frame.plan(task.ground.problem, links, plan.bindings.lines())

    def _completion(self, plan: LiftedPlan) -> tuple[Bindings, Orderings] | None:
        """Objects for all variables and a schedule with them, of several the shortest; None if there are none."""
        task, world = self._task.ground, self._task.world
        found: tuple[Bindings, Orderings] | None = None
        all_shortest = True
        completions = plan.bindings.completions()
        for bindings in itertools.islice(completions, MAX_COMPLETIONS):
            try:
                schedule = scheduled(plan.orderings, _names(plan, bindings), task, world)
            except UnsettledError:
                self._unsettled = True
                continue
            if schedule is not None:
                all_shortest &= schedule.is_shortest
                if found is None or makespan(schedule.orderings) < makespan(found[1]):
                    found = bindings, schedule.orderings
                if makespan(found[1]) == makespan(plan.orderings):
                    return found
        more = next(completions, None) is not None
        self._unsettled |= found is None and more
        self._unshortened |= found is not None and (more or not all_shortest)
        return found

    def _links(self, plan: LiftedPlan, bindings: Bindings) -> Iterator[Link]:
        cell = plan.links
        while cell is not None:
            producer, consumer = self._task.step_of(cell.producer), self._task.step_of(cell.first)
            yield Link(producer, _ground(cell.literal, bindings), consumer)
            cell = cell.rest


def _names(plan: LiftedPlan, bindings: Bindings) -> tuple[Fact, ...]:
    """The actions of the steps."""
    return tuple(
        (schema.name, *(_value(bindings, (parameter.name, step)) for parameter in schema.parameters))
        for step, schema in enumerate(plan.steps, 1)
    )


def _value(bindings: Bindings, term: str | tuple[str, int]) -> str:
    value = bindings.value(term)
    assert value is not None
    return value


def _ground(literal: LiftedLiteral, bindings: Bindings) -> Literal:
    return Literal((literal.predicate, *(_value(bindings, term) for term in literal.terms)), literal.positive)
