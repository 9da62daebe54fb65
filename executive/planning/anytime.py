"""Anytime search: first any plan, then ever better ones by the problem's metric, as long as the budget lasts."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from typing import Any

from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.ground.ground_task import GroundTask, make_task
from tailor.executive.planning.improvement_bound import ImprovementBound
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plan_quality import Measure, measure_of, quality
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.search import GroundCache, Search, plan_space
from tailor.executive.planning.settings import DEFAULT, DEFAULT_RANKINGS, Settings, rankings_for
from tailor.executive.planning.structures.random_source import RandomSource


class AnytimeSearch:
    """A search for ever better plans of one problem, advanced in portions of any size.

    The first plan is the one that is found most surely (rankings ADDR/ADDR_WORK/BUC/LIFO unless chosen). Then
    partial-order search goes through plan space once more, ranked by the metric: partial plans that already last as
    long, cost as much or have as many steps as the best plan are dropped. Of makespans there are two such searches, by
    turns: the second one ranks by the least makespan that the use of exclusive facts leaves.
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
        self._improving: list[BestFirst[Any]] = []
        self._work = self._run()
        self.measure: Measure = measure_of(problem)
        self.best: Result | None = None  # the best plan so far, or why there is none
        self.value = float("inf")  # of the best plan by the measure
        self.ended = ""  # why the search has ended: "proven" if there is no better plan, or a limit

    @property
    def counts(self) -> tuple[int, int]:
        """Numbers of plans generated and visited so far."""
        generated, visited = self._first.counts
        generated += sum(engine.generated for engine in self._improving)
        return generated, visited + sum(engine.visited for engine in self._improving)

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
        bound = yield from self._bound(task)
        spaces = [(yield from plan_space(task, grounded, settings, RandomSource(settings.seed)))]
        if bound.is_sharp and not self._settings.rankings:
            spaces.append((yield from plan_space(task, grounded, settings, RandomSource(settings.seed))))
            spaces[1].rank = bound.ranked_by_makespan(spaces[1].rank)
            settings = replace(settings, node_limit=settings.node_limit // 2)
        engines = [BestFirst[Any](space, settings) for space in spaces]
        for engine in engines:
            engine.goes_on, engine.is_hopeless = True, bound.is_hopeless
            engine.max_entries //= len(engines)
        self._improving = engines
        yield from self._by_turns([engine.run() for engine in engines], bound)

    def _bound(self, task: GroundTask) -> Generator[None, None, ImprovementBound]:
        """The bound by the first plan; of makespans of ground plans by exclusive facts, too."""
        assert self.best is not None
        assert self.best.plan is not None
        if self.measure != "makespan" or not task.temporal or not self._settings.ground:
            return ImprovementBound(self.measure, task, self.value)
        # loaded here: only problems in which actions take time have a use for them
        from tailor.executive.planning.bounds.exclusive_facts import exclusive_facts
        from tailor.executive.planning.bounds.occupation import Occupation

        occupation = Occupation(task, (yield from exclusive_facts(task)))
        mean = sum(step.duration for step in self.best.plan.steps) / max(len(self.best.plan.steps), 1)
        return ImprovementBound(self.measure, task, self.value, occupation, mean)

    def _by_turns(self, searches: list[Iterator[Result | None]], bound: ImprovementBound) -> Iterator[Result | None]:
        """Advances each search by one plan in turn until one has a proof or all have reached a limit."""
        while searches:
            for search in searches.copy():
                result = next(search)
                if result is None:
                    yield None
                elif result.plan is not None:
                    yield self._better(result, bound)
                elif result.status == "unsolvable" or len(searches) == 1:
                    self.ended = "proven" if result.status == "unsolvable" else result.reason
                    yield None
                    return
                else:
                    searches.remove(search)

    def _better(self, result: Result, bound: ImprovementBound) -> Result | None:
        """The result with a better plan, as the best one from now on; None if its plan is no better."""
        assert result.plan is not None
        if not bound.is_better(value := quality(result.plan, self._problem)):
            return None
        self.value = value
        bound.lower(value)
        self.best = replace(result, generated=self.counts[0], visited=self.counts[1])
        return self.best
