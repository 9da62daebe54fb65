"""Plan space of a lifted task."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground_plans.extraction import Frame, scheduled
from tailor.executive.planning.ground_plans.separation import UnsettledError, makespan
from tailor.executive.planning.lifted.bindings import Bindings
from tailor.executive.planning.lifted.formula import LiftedLiteral
from tailor.executive.planning.lifted.lifted_plan import LiftedCondition, LiftedPlan, LiftedThreat, initial_plan
from tailor.executive.planning.lifted.measures import LiftedMeasures
from tailor.executive.planning.lifted.open_conditions import refine_condition
from tailor.executive.planning.lifted.task import LiftedTask
from tailor.executive.planning.lifted.threats import refine_threat
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.plan_space import PlanSpace
from tailor.executive.planning.plans.plan import Link, Plan, by_consumer
from tailor.executive.planning.settings import Settings
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.orderings import Orderings
from tailor.executive.planning.structures.random_source import RandomSource

MAX_COMPLETIONS = 10  # tried for a schedule; nearly always the first one has one


class LiftedSpace(PlanSpace[LiftedPlan]):
    """See `PlanSpace`."""

    def __init__(self, task: LiftedTask, settings: Settings, rng: RandomSource) -> None:
        measures = LiftedMeasures(task)
        super().__init__(task.ground, settings, measures, measures, rng)
        self._task = task

    def initial(self) -> LiftedPlan:
        """See `PlanSpace`."""
        return initial_plan(self._task)

    def is_complete(self, plan: LiftedPlan) -> bool:
        """See `PlanSpace`; there must be an object for every variable, too."""
        return self._completion(plan) is not None

    def _resolvers(self, plan: LiftedPlan, flaw: LiftedCondition | LiftedThreat) -> list[LiftedPlan]:
        if isinstance(flaw, LiftedCondition):
            return refine_condition(self._task, plan, flaw)
        return refine_threat(self._task, plan, flaw)

    def extract(self, plan: LiftedPlan) -> Plan:
        """See `PlanSpace`; the bindings are lines as VHPOP prints them."""
        completion = self._completion(plan)
        assert completion is not None
        bindings, orderings = completion
        frame = Frame(_names(plan, bindings), orderings, self._ground)
        links = by_consumer(self._links(plan, bindings), frame.steps())
        return frame.plan(links, plan.bindings.lines())

    def _completion(self, plan: LiftedPlan) -> tuple[Bindings, Orderings] | None:
        """Objects for all variables and a schedule with them, of several the shortest; None if there are none."""
        world = self._task.world
        found: tuple[Bindings, Orderings] | None = None
        all_shortest = True
        completions = plan.bindings.completions()
        for bindings in itertools.islice(completions, MAX_COMPLETIONS):
            try:
                schedule = scheduled(plan.orderings, _names(plan, bindings), self._ground, world)
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
        for cell in cells_of(plan.links):
            producer, consumer = self._ground.step_of(cell.producer), self._ground.step_of(cell.first)
            yield Link(producer, _ground(cell.literal, bindings), consumer)


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
