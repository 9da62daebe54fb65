"""Problems and plans of unified-planning as ours, and back."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from unified_planning.io import PDDLWriter
from unified_planning.model import DurativeAction
from unified_planning.model.walkers import Simplifier
from unified_planning.plans import ActionInstance, PartialOrderPlan, PlanKind, TimeTriggeredPlan

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning import Domain, Plan, Problem, Step, parse_domain, parse_problem
from tailor.executive.planning.pddl.language import Action, Condition, DurationBound, Number, Or
from tailor.tools.plan_search.transitive_reduction import transitive_reduction
from tailor.tools.up_engine.pddl_writing import written
from tailor.tools.up_engine.time_rules import is_whole, overlap, without_overlap

DEFAULT_TICK_S = 0.01
ROUNDING_S = Fraction(1, 10**9)  # our times are whole nanoseconds
EXACT_TICK_S = 1e-6  # of plans to validate: their times are fractions, not rounded to ticks


# the only durative action of a domain whose own ones are never possible and left out by the writer: plans keep times
NEVER = Action("never ", (), (Condition(Or(())),), (), (DurationBound("=", Number(1.0)),))


@dataclass(frozen=True, slots=True)
class Translation:
    """A problem of unified-planning, its PDDL read by our parser, and the writer that keeps both kinds of names."""

    original: Any
    writer: PDDLWriter
    domain: Domain
    problem: Problem

    @classmethod
    def of(cls, original: Any) -> Translation:
        """The translation of a problem.

        Raises:
          Unsupported: It has a feature that we or PDDL do not have.
          UsageError: It is larger than our parser allows.
        """
        text = written(original)
        domain = parse_domain(text.domain, "domain")
        if _takes_time(original) and not domain.durative:
            domain = replace(domain, actions=(*domain.actions, NEVER))
        problem = replace(parse_problem(text.problem, domain, "problem"), changes_apart=True)
        return cls(original, text.writer, domain, problem if text.is_possible else problem.with_goal("(or)"))

    @property
    def timed(self) -> bool:
        """Whether plans have durations or depend on times."""
        return self.domain.durative or bool(self.problem.timed)

    @property
    def tick_s(self) -> float:
        """The least time between dependent events: the problem's epsilon, or our default; that without times, too.

        In discrete time, it is a whole number.
        """
        epsilon = self.original.epsilon if self.timed else None
        if self.timed and self.original.discrete_time:
            return float(math.ceil(epsilon or 1))
        return float(epsilon or DEFAULT_TICK_S)

    def without_overlap(self) -> Translation:
        """The same problem, in which no action overlaps itself."""
        domain = without_overlap(self.domain)
        return replace(self, domain=domain, problem=replace(self.problem, domain=domain))

    def overlap(self, plan: Plan) -> str:
        """The action that overlaps itself in a plan although the problem forbids that; empty if there is none."""
        return overlap(self.original, self.to_unified(plan)) if self.timed else ""

    def is_whole(self, plan: Plan) -> bool:
        """Whether a plan's times are whole numbers, or need not be."""
        return not self.timed or is_whole(self.original, self.to_unified(plan))

    # --- plans -----------------------------------------------------------------------------------
    def to_unified(self, plan: Plan) -> Any:
        """A partial-order plan without the orderings that others imply, or a time-triggered plan."""
        instances = {step.id: self._instance(step.action) for step in plan.steps}
        if not self.timed:
            after: dict[Any, list[Any]] = {instance: [] for instance in instances.values()}
            for i, j in transitive_reduction(plan.orderings):
                after[instances[i]].append(instances[j])
            return PartialOrderPlan(after, self.original.environment)
        timed = [
            (_fraction(step.start), instances[step.id], self._duration(step, instances[step.id])) for step in plan.steps
        ]
        return TimeTriggeredPlan(timed, self.original.environment)

    def from_unified(self, plan: Any) -> Plan:
        """A partial-order, sequential or time-triggered plan as ours, without causal links.

        Raises:
          UPException: It has an action or object that is not of the problem.
        """
        if plan.kind is PlanKind.TIME_TRIGGERED_PLAN:
            steps = [
                Step(n, self._fact(action), float(start), float(duration or 0))
                for n, (start, action, duration) in enumerate(plan.timed_actions, 1)
            ]
            orderings = [(a.id, b.id) for a in steps for b in steps if a.start < b.start]
            return self._plan(sorted(steps, key=lambda step: step.start), orderings)
        if plan.kind is PlanKind.PARTIAL_ORDER_PLAN:
            after = plan.get_adjacency_list
            ids = {action: n for n, action in enumerate(after, 1)}
            orderings = [(ids[first], ids[then]) for first, others in after.items() for then in others]
            return self._plan((Step(n, self._fact(action), float(n)) for action, n in ids.items()), orderings)
        steps = [Step(n, self._fact(action), float(n)) for n, action in enumerate(plan.actions, 1)]
        return self._plan(steps, [(n, n + 1) for n in range(1, len(steps))])

    def _plan(self, steps: Iterable[Step], orderings: Iterable[tuple[int, int]]) -> Plan:
        problem = self.problem
        return Plan(problem.name, problem.initial, tuple(steps), (), tuple(orderings), self.timed, (), EXACT_TICK_S)

    def _instance(self, action: Fact) -> ActionInstance:
        name, *labels = (self.writer.get_item_named(label) for label in action)
        return ActionInstance(name, tuple(self.original.environment.expression_manager.ObjectExp(x) for x in labels))

    def _fact(self, instance: Any) -> Fact:
        items = [instance.action, *(parameter.object() for parameter in instance.actual_parameters)]
        return tuple(self.writer.get_pddl_name(item) for item in items)

    def _duration(self, step: Step, instance: ActionInstance) -> Fraction | None:
        """The duration of a step, None of an instantaneous action.

        A limit of the action's durations that PDDL text rounds, such as 1/3, is kept as it is.
        """
        if not any(action.name == step.action[0] and action.duration is not None for action in self.domain.actions):
            return None
        duration, simplifier = _fraction(step.duration), Simplifier(self.original.environment, self.original)
        objects = dict(zip(instance.action.parameters, instance.actual_parameters, strict=True))
        for limit in (instance.action.duration.lower, instance.action.duration.upper):
            value = simplifier.simplify(limit.substitute(objects))
            if value.is_constant() and abs(Fraction(value.constant_value()) - duration) < ROUNDING_S:
                return Fraction(value.constant_value())
        return duration


def _takes_time(original: Any) -> bool:
    """Whether the plans of a problem are time-triggered for unified-planning."""
    return bool(original.timed_effects) or any(isinstance(action, DurativeAction) for action in original.actions)


def _fraction(seconds: float) -> Fraction:
    """The decimal number that a plan prints."""
    return Fraction(repr(float(seconds)))
