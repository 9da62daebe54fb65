"""Reuse of the last plan: its remaining suffix, or a shorter plan that was searched while an action ran.

The search for a shorter plan has the lowest priority. Its result is adopted between actions only.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.core.plan_source import PlanFound, current_problem, validated
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact


class Improvement:
    """One search for a plan that is better than the rest of `plan` after its step `step`."""

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
        """Prepare the search; all work is done in `advance`.

        Args:
          context: Domain and settings.
          plan: The plan that is being executed.
          step: Id of its step that is running.
          left: Ids of its steps that come later.
          expected: The abstract state expected at the end of the step.
          goal: PDDL; empty: the scenario's.
          ground: Grounding of earlier searches.
        """
        self._plan, self._step, self._expected = plan, step, expected
        self._facts: frozenset[Fact] | None = None
        self._domain = context.pddl_domain
        self._result: planning.Result | None = None
        self._search: planning.Search | None = None
        if len(left) > (0 if plan.durative else 1):
            settings = _bounded(context, None if plan.durative else len(left) - 1)
            problem = current_problem(context, expected, goal)
            self._search = planning.Search(context.pddl_domain, problem, settings, ground)

    def serves(self, plan: planning.Plan, step: int, expected: frozenset[Fact]) -> bool:
        """Whether this search starts from the state `expected` after that step of that plan."""
        return self._plan is plan and self._step == step and self._expected == expected

    def note(self, facts: frozenset[Fact]) -> None:
        """Store the abstract state from which the step leads to the expected one; `follows` compares with it."""
        self._facts = facts

    def follows(self, plan: planning.Plan, step: int, facts: frozenset[Fact]) -> bool:
        """Whether this search is for that step of that plan, started in the abstract state last noted."""
        return self._plan is plan and self._step == step and self._facts == facts

    def advance(self, budget: Budget) -> None:
        """Continue until the search has ended or the budget is spent."""
        if self._search is not None and self._result is None:
            self._result = self._search.advance(budget)

    def plan_from(self, problem: planning.Problem) -> PlanFound | None:
        """The plan that was found, as one of `problem`; None if there is none or it is unsound from there."""
        if self._result is None or self._result.plan is None:
            return None
        plan = replace(self._result.plan, initial=problem.initial)
        found = validated(replace(self._result, plan=plan), "improved", self._domain, problem)
        return found if found.plan is not None else None


def better(plan: planning.Plan, other: planning.Plan) -> bool:
    """Strict comparison: by makespan for durative plans, otherwise by number of steps."""
    if plan.durative:
        return plan.makespan < other.makespan
    return len(plan.steps) < len(other.steps)


def reusable(
    context: Context,
    problem: planning.Problem,
    plan: planning.Plan | None,
    done: frozenset[int],
    improvement: Improvement | None,
) -> PlanFound | None:
    """A plan that is sound from the problem's initial state and needs no search; None if there is none.

    Args:
      context: Domain and settings.
      problem: The problem of now.
      plan: The last plan, if there was one.
      done: Ids of its steps that have been executed.
      improvement: The last search for a better plan; None: do not use one, because an action is running.
    """
    if plan is None:
        return None
    left = _suffix(plan, done, context.pddl_domain, problem)
    found = improvement.plan_from(problem) if improvement is not None else None
    if found is not None and found.plan is not None and (left is None or better(found.plan, left)):
        return found
    return PlanFound("solved", "suffix", left, 0, 0) if left is not None else None


def _suffix(
    previous: planning.Plan, done: frozenset[int], domain: planning.Domain, problem: planning.Problem
) -> planning.Plan | None:
    """The shortest suffix of a plan that is sound now; steps whose effects hold already are left out."""
    remaining = [step.id for step in previous.steps if step.id not in done]
    for skipped in range(len(remaining), -1, -1):
        plan = planning.suffix(previous, done | set(remaining[:skipped]), domain, problem)
        if plan is not None:
            return plan
    return None


def _bounded(context: Context, steps: int | None) -> planning.Settings:
    """The planner's settings, limited to `improve_plans` generated plans and to `steps` steps."""
    planner = context.settings.planner
    nodes = min(planner.node_limit, context.settings.improve_plans)
    limit = planner.step_limit if steps is None else steps
    return replace(planner, engine="pocl", node_limit=nodes, step_limit=limit)  # the other engine's plans are longer
