"""Anytime search: first any plan, then ever better ones by the problem's metric, as long as the budget lasts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.ground.ground_task import GroundTask, make_task
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plan_quality import Measure, measure_of, quality
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.search import GroundCache, Search, plan_space
from tailor.executive.planning.settings import DEFAULT, DEFAULT_RANKINGS, Settings, rankings_for
from tailor.executive.planning.structures.orderings import GOAL
from tailor.executive.planning.structures.random_source import RandomSource
from tailor.executive.planning.structures.refinable import Refinable

SLACK, RELATIVE_SLACK = 1e-9, 1e-12  # of sums of costs: the lesser of the two; floats have 16 digits


class AnytimeSearch:
    """A search for ever better plans of one problem, advanced in portions of any size.

    The first plan is the one that is found most surely (rankings ADDR/ADDR_WORK/BUC/LIFO unless chosen). Then
    partial-order search goes through plan space once more, ranked by the metric: partial plans that already last as
    long, cost as much or have as many steps as the best plan are dropped.
    """

    def __init__(
        self, domain: Domain, problem: Problem, settings: Settings = DEFAULT, ground: GroundCache | None = None
    ) -> None:
        """Stores the problem; all work is done in `advance`. Arguments as those of `Search`."""
        self._problem = problem
        self._settings = settings
        self._cache = ground if ground is not None else GroundCache()
        rankings = settings.rankings or DEFAULT_RANKINGS
        self._first = Search(domain, problem, replace(settings, rankings=rankings), self._cache)
        self._second: BestFirst[Any] | None = None
        self._work = self._run()
        self.measure: Measure = measure_of(problem)
        self.best: Result | None = None  # the best plan so far, or why there is none
        self.value = float("inf")  # of the best plan by the measure
        self.ended = ""  # why the search has ended: "proven" if there is no better plan, or a limit

    @property
    def counts(self) -> tuple[int, int]:
        """Numbers of plans generated and visited so far."""
        generated, visited = self._first.counts
        if self._second is not None:
            generated, visited = generated + self._second.generated, visited + self._second.visited
        return generated, visited

    def advance(self, budget: Budget) -> Result | None:
        """Continues until a better plan is found, the search ends or the budget is spent.

        Args:
          budget: Checked as by `Search.advance`.

        Returns:
          The first plan (or why there is none), then each better one; None if the budget was spent or all is done.
        """
        while not self.ended and not budget.spent():
            result = next(self._work)
            if result is not None:
                return result
        return None

    def _run(self) -> Iterator[Result | None]:
        while (first := self._first.advance(CheckBudget(1))) is None:
            yield None
        self.best = first
        if first.plan is None:
            self.ended = first.reason
            yield first
            return
        self.value = quality(first.plan, self._problem)
        yield first
        try:
            yield from self._improvements()
        except TooMuchToGround as reason:  # lifted search meets some conditions only here
            self.ended = str(reason)
            yield None

    def _improvements(self) -> Iterator[Result | None]:
        """Better and better plans; sets `ended` before the last yield."""
        settings = replace(self._settings, rankings=rankings_for(self._settings, self.measure), search="A")
        if self.measure == "cost":
            settings = replace(settings, action_cost="metric")
        grounded = self._cache.last
        assert grounded is not None
        task: GroundTask = yield from make_task(self._problem, grounded, settings.action_cost)
        space = yield from plan_space(task, grounded, settings, RandomSource(settings.seed))
        engine = BestFirst[Any](space, settings)
        bound = _Bound(self.measure, task, self.value)
        engine.goes_on, engine.is_hopeless = True, bound.is_hopeless
        self._second = engine
        for result in engine.run():
            if result is None:
                yield None
            elif result.plan is None:
                self.ended = "proven" if result.status == "unsolvable" else result.reason
                yield None
                return
            elif bound.is_better(value := quality(result.plan, self._problem)):
                self.value = value
                bound.lower(value)
                self.best = replace(result, generated=self.counts[0], visited=self.counts[1])
                yield self.best
            else:
                yield None


class _Bound:
    """Recognises partial plans that can only become as good as the best plan, or worse."""

    def __init__(self, measure: Measure, task: GroundTask, value: float) -> None:
        self._measure, self._task = measure, task
        self.lower(value)

    def lower(self, value: float) -> None:
        """Sets the value of the best plan."""
        slack = min(SLACK, value * RELATIVE_SLACK) if self._measure == "cost" else 0
        self._limit = self._exact(value) - slack

    def is_better(self, value: float) -> bool:
        """Whether a plan of this value is better than the best one."""
        return self._exact(value) < self._limit

    def is_hopeless(self, plan: Refinable) -> bool:
        """Whether all plans below are no better; times and costs only grow as steps are added."""
        match self._measure:
            case "cost":
                return plan.cost >= self._limit
            case "makespan":
                return plan.orderings.earliest()[GOAL] >= self._limit
            case _:
                return len(plan.steps) >= self._limit

    def _exact(self, value: float) -> float:
        """A makespan in whole units of the time grid: durations may differ by a nanosecond."""
        return self._task.grid.units(value) if self._measure == "makespan" and self._task.temporal else value
