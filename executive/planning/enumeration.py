"""Different plans for one problem, in the order in which partial-order search finds them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import takewhile
from typing import Any

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan, Result
from tailor.executive.planning.search import GroundCache, plan_space
from tailor.executive.planning.settings import Settings
from tailor.executive.planning.structures.random_source import RandomSource

MORE_STEPS = (0, 1)  # than a known plan, one search each: the longer plans are many


class PlanEnumeration:
    """Plans that differ in their steps or in the order of these: first those as short as a known plan, then others.

    Each search goes on after a plan, until all are found or a limit is reached. Of a plan with variables (lifted) one
    choice of objects is found, not all.

    Args:
      problem: Grounded by an earlier search.
      settings: Its ranking and flaw orders, and the limit of generated plans for each search.
      ground: The cache of that search.
      known: A plan that is not to be found again.
    """

    def __init__(self, problem: Problem, settings: Settings, ground: GroundCache, known: Plan) -> None:
        self._problem = problem
        self._settings = replace(settings, search="A", engine="pocl")
        self._ground = ground
        self._steps = len(known.steps)
        self._seen: set[tuple[Fact, ...]] = {_actions(known)}
        self._work = self._run()
        self.finished = False

    def advance(self, budget: Budget) -> Plan | None:
        """Continues until another plan is found, the search ends (`finished`) or the budget is spent.

        Args:
          budget: Checked once per refined plan.

        Returns:
          The plan; None if there is none yet, or no other.
        """
        while not self.finished and not budget.spent():
            found = next(self._work, None)
            if found is not None:
                return found
        return None

    def _run(self) -> Iterator[Plan | None]:
        grounded = self._ground.last
        assert grounded is not None, "the problem has been planned before"
        task = yield from make_task(self._problem, grounded, self._settings.action_cost)
        for more in MORE_STEPS:
            settings = replace(self._settings, step_limit=self._steps + more)
            space = yield from plan_space(task, grounded, settings, RandomSource(settings.seed))
            engine = BestFirst[Any](space, settings)
            engine.goes_on = True
            yield from map(self._new_plan, takewhile(_goes_on, engine.run()))
        self.finished = True
        yield None

    def _new_plan(self, result: Result | None) -> Plan | None:
        """The plan of a result unless it has been found before."""
        if result is None or result.plan is None or _actions(result.plan) in self._seen:
            return None
        self._seen.add(_actions(result.plan))
        return result.plan


def _goes_on(result: Result | None) -> bool:
    """Whether a search has not ended: proven that there is no other plan, or at a limit."""
    return result is None or result.plan is not None


def _actions(plan: Plan) -> tuple[Fact, ...]:
    """The actions in the order of their execution."""
    return tuple(step.action for step in plan.steps)
