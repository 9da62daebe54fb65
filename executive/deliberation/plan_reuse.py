"""Reuse of the last plan: its remaining suffix, or a better plan that was searched while an action ran.

Both are prepared while an action runs, from the abstract state that is expected at its end. The search for a better
plan has the lowest priority. Its result is adopted between actions only.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.plan_found import PlanFound, validated
from tailor.executive.deliberation.plan_source import REUSE_FREE_PORTIONS, current_problem
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact


class Preparation:
    """What is prepared while a step of a plan runs: the plan's suffix after it, and one search for a better plan."""

    def __init__(
        self,
        context: Context,
        plan: planning.Plan,
        step: int,
        done: frozenset[int],
        expected: frozenset[Fact],
        goal: str,
        ground: planning.GroundCache,
    ) -> None:
        """Prepare the work; all of it is done in `advance`.

        Args:
          context: Domain and settings.
          plan: The plan that is being executed.
          step: Id of its step that is running.
          done: Ids of its steps that have been executed before.
          expected: The abstract state expected at the end of the step.
          goal: PDDL; empty: the scenario's.
          ground: Grounding of earlier searches.
        """
        self._plan, self._step, self._expected = plan, step, expected
        self._facts: frozenset[Fact] | None = None
        self._done = done | {step}
        self._domain = context.pddl_domain
        self._problem = current_problem(context, expected, goal)
        suffix = planning.shortest_suffix(plan, self._done, self._domain, self._problem)
        self._suffix = planning.PacedWork(suffix, REUSE_FREE_PORTIONS)
        self._result: planning.Result | None = None
        self._search: planning.Search | planning.AnytimeSearch | None = None
        left = len({other.id for other in plan.steps} - self._done)
        measured = _measured(self._problem)
        if context.settings.improve_plans and left > (0 if measured else 1):
            if measured:
                self._search = planning.AnytimeSearch(self._domain, self._problem, _bounded(context, None, 2), ground)
            else:
                self._search = planning.Search(self._domain, self._problem, _bounded(context, left - 1), ground)

    def serves(self, plan: planning.Plan, step: int, expected: frozenset[Fact]) -> bool:
        """Whether this starts from the state `expected` after that step of that plan."""
        return self._plan is plan and self._step == step and self._expected == expected

    def note(self, facts: frozenset[Fact]) -> None:
        """Store the abstract state from which the step leads to the expected one; `follows` compares with it."""
        self._facts = facts

    def follows(self, plan: planning.Plan, step: int, facts: frozenset[Fact]) -> bool:
        """Whether this is for that step of that plan, started in the abstract state last noted."""
        return self._plan is plan and self._step == step and self._facts == facts

    def advance_suffix(self, budget: Budget) -> bool:
        """Continue with the suffix alone; whether it is ready."""
        return self._suffix.advance(budget)

    def advance(self, budget: Budget) -> None:
        """Continue until all is done or the budget is spent."""
        if not self.advance_suffix(budget) or self._search is None:
            return
        if isinstance(self._search, planning.AnytimeSearch):
            while self._search.advance(budget) is not None:  # each plan is better than the one before
                pass
            self._result = self._search.best
        elif self._result is None:
            self._result = self._search.advance(budget)

    def suffix(
        self, plan: planning.Plan, done: frozenset[int], problem: planning.Problem
    ) -> planning.Work[planning.Plan | None] | None:
        """The rest of the work on the shortest sound suffix; None if it was prepared for something else."""
        same = self._plan is plan and self._done == done and self._problem == problem
        return self._suffix.rest() if same else None

    def better_plan(self, problem: planning.Problem) -> planning.Work[PlanFound | None]:
        """The plan that was found, as one of `problem`; None if there is none or it is unsound from there."""
        if self._result is None or self._result.plan is None:
            return None
        plan = replace(self._result.plan, initial=problem.initial)
        found = yield from validated(replace(self._result, plan=plan), "improved", self._domain, problem)
        return found if found.plan is not None else None


def better(plan: planning.Plan, other: planning.Plan, problem: planning.Problem) -> bool:
    """Strict comparison: by cost or makespan if the problem has costs or durations, otherwise by number of steps."""
    if _measured(problem):
        return planning.quality(plan, problem) < planning.quality(other, problem)
    return len(plan.steps) < len(other.steps)


def _measured(problem: planning.Problem) -> bool:
    """Whether plans differ by more than their numbers of steps."""
    return problem.domain.durative or problem.metric == "cost"


def reuse(
    context: Context,
    problem: planning.Problem,
    plan: planning.Plan,
    done: frozenset[int],
    preparation: Preparation | None,
) -> planning.Work[PlanFound | None]:
    """A plan that is sound from the problem's initial state and needs no search; None if there is none.

    Args:
      context: Domain and settings.
      problem: The problem of now.
      plan: The last plan.
      done: Ids of its steps that have been executed.
      preparation: What was prepared during the last action; None: do not use it, because an action is running.
    """
    prepared = preparation.suffix(plan, done, problem) if preparation is not None else None
    left = yield from prepared or planning.shortest_suffix(plan, done, context.pddl_domain, problem)
    found = (yield from preparation.better_plan(problem)) if preparation is not None else None
    rest = PlanFound("solved", "suffix", left, 0, 0) if left is not None else None
    if found is not None and found.plan is not None and (left is None or better(found.plan, left, problem)):
        return replace(found, instead=rest)
    return rest


def _bounded(context: Context, steps: int | None, searches: int = 1) -> planning.Settings:
    """The planner's settings, limited to `improve_plans` generated plans in so many searches, and to `steps` steps."""
    planner = context.settings.planner
    nodes = min(planner.node_limit, context.settings.improve_plans // searches)
    limit = planner.step_limit if steps is None else steps
    return replace(planner, engine="pocl", node_limit=nodes, step_limit=limit)  # the other engine's plans are longer
