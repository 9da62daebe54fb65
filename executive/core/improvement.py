"""Looks for a better plan while an action runs: from the state that is expected at the action's end.

It has the lowest priority, and changes nothing by itself: the plan is looked at when the action is done.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.core.plan_finding import PlanFound, problem_of_now, validated
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact


class Improvement:
    """One search for a plan that is better than what will be left of `plan` after its step `step`."""

    def __init__(
        self,
        context: Context,
        plan: planning.Plan,
        step: int,
        left: Collection[int],
        expected: frozenset[Fact],
        goal: str,
        ground: planning.GroundCache,
    ) -> None:
        """Prepares; all work is done in `advance`.

        Args:
          context: Domain and settings.
          plan: The plan that is being executed.
          step: Its step that is running.
          left: Ids of its steps that come later.
          expected: The abstract state as it should be when the step is done.
          goal: PDDL.
          ground: The grounding of earlier searches.
        """
        self._plan, self._step, self._expected = plan, step, expected
        self._facts: frozenset[Fact] | None = None
        self._domain = context.pddl_domain
        self._result: planning.Result | None = None
        self._search: planning.Search | None = None
        if len(left) > (0 if plan.durative else 1):
            settings = _bounded(context, None if plan.durative else len(left) - 1)
            problem = problem_of_now(context, expected, goal)
            self._search = planning.Search(context.pddl_domain, problem, settings, ground)

    def serves(self, plan: planning.Plan, step: int, expected: frozenset[Fact]) -> bool:
        """Whether this is the search for what comes after that step."""
        return self._plan is plan and self._step == step and self._expected == expected

    def note(self, facts: frozenset[Fact]) -> None:
        """Remember facts from which the step leads to what is expected: `follows` then knows them again."""
        self._facts = facts

    def follows(self, plan: planning.Plan, step: int, facts: frozenset[Fact]) -> bool:
        """Whether this is known to be the search for what comes after that step, taken from these facts."""
        return self._plan is plan and self._step == step and self._facts == facts

    def advance(self, budget: Budget) -> None:
        """Go on until the search has ended or the budget is spent."""
        if self._search is not None and self._result is None:
            self._result = self._search.advance(budget)

    def plan_from(self, problem: planning.Problem) -> PlanFound | None:
        """The plan that was found, as one of `problem`; None if there is none or it is not sound from there."""
        if self._result is None or self._result.plan is None:
            return None
        plan = replace(self._result.plan, initial=problem.initial)
        found = validated(replace(self._result, plan=plan), "improved", self._domain, problem)
        return found if found.plan is not None else None


def better(plan: planning.Plan, other: planning.Plan) -> bool:
    """Strictly: sooner done where actions take time, else fewer steps."""
    if plan.durative:
        return plan.makespan < other.makespan
    return len(plan.steps) < len(other.steps)


def _bounded(context: Context, steps: int | None) -> planning.Settings:
    """The planner's settings within the limits of a search that nobody waits for."""
    planner = context.settings.planner
    nodes = min(planner.node_limit, context.settings.improve_plans)
    return replace(planner, node_limit=nodes, step_limit=planner.step_limit if steps is None else steps)
