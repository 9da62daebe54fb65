"""Resumable search for a plan: grounding, then search, with one budget check per refined plan or evaluated state."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from typing import Any

from tailor.executive.interfaces.budget import Budget
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.deepening import Deepening
from tailor.executive.planning.forward_engine import ForwardEngine
from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.ground.ground_task import GroundTask, make_task
from tailor.executive.planning.ground.grounding import GroundActions, ground_actions, shuffled, static_world
from tailor.executive.planning.ground.instances import NegativeCost
from tailor.executive.planning.ground_space import GroundSpace
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plan_space import PlanSpace
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.portfolio import HEAD_START, Engine, Portfolio, head_start
from tailor.executive.planning.settings import DEFAULT, DEFAULT_RANKINGS, Settings, rankings_for
from tailor.executive.planning.structures.random_source import RandomSource


class GroundCache:
    """Keeps the last grounding for reuse while domain, objects and static facts are unchanged."""

    def __init__(self) -> None:
        """Starts empty; `Search` fills it."""
        self.last: GroundActions | None = None


class Search:
    """A search for a plan of one problem, advanced in portions of any size."""

    def __init__(
        self, domain: Domain, problem: Problem, settings: Settings = DEFAULT, ground: GroundCache | None = None
    ) -> None:
        """Stores the problem; all work is done in `advance`.

        Args:
          domain: The problem's domain; must equal `problem.domain`.
          problem: Initial state and goal.
          settings: Rankings, flaw orders, limits, random seed.
          ground: Cache to share between searches: replanning skips grounding while static facts are unchanged.
        """
        assert problem.domain == domain, "the problem belongs to another domain"
        self._course = _Course(problem, settings, ground if ground is not None else GroundCache())
        self._work = self._course.run()
        self._result: Result | None = None

    @property
    def counts(self) -> tuple[int, int]:
        """Numbers of plans generated and visited so far."""
        return self._course.counts

    def advance(self, budget: Budget) -> Result | None:
        """Continues the search until it ends or the budget is spent.

        Deterministic for equal problem and settings, however the work is divided among calls.

        Args:
          budget: Checked once per refined plan or evaluated state, and once per 64 bindings while grounding.

        Returns:
          The result, and the same one at every later call; None if the budget was spent first: call again.
        """
        while self._result is None and not budget.spent():
            self._result = next(self._work)
        return self._result


class _Course:
    """What a search does. It does not hold its own generator, so an abandoned search is freed without a collection."""

    def __init__(self, problem: Problem, settings: Settings, cache: GroundCache) -> None:
        self._problem, self._settings, self._cache = problem, settings, cache
        self._engine: Engine | None = None

    @property
    def counts(self) -> tuple[int, int]:
        """As of `Search`."""
        return (self._engine.generated, self._engine.visited) if self._engine else (0, 0)

    def run(self) -> Iterator[Result | None]:
        """The result at last, None after each portion before."""
        settings = self._settings
        rng = RandomSource(settings.seed)
        try:
            yield from self._ground()
            grounded = self._cache.last
            assert grounded is not None
            if settings.random_open_conditions:
                grounded = shuffled(grounded, rng)
            self._engine = yield from self._make_engine(grounded, rng)
            yield from self._engine.run()
        except TooMuchToGround as reason:
            yield Result("limit", None, str(reason), *self.counts)
        except NegativeCost as found:
            yield Result("unsupported", None, f"{found} is not supported: it is below 0", *self.counts)

    def _make_engine(self, grounded: GroundActions, rng: RandomSource) -> Generator[None, None, Engine]:
        """The engine of the settings."""
        settings = self._settings
        task = yield from make_task(self._problem, grounded, settings.action_cost)
        if settings.engine == "pocl":
            return (yield from self._partial_order(task, grounded, rng))
        forward = ForwardEngine(task, grounded, settings.node_limit, settings.step_limit)
        if settings.engine == "forward":
            return forward
        partial = yield from self._partial_order(task, grounded, rng)
        if not forward.applies:
            return partial
        return Portfolio(partial, forward, head_start(forward.expected_steps, len(task.goal)))

    def _partial_order(
        self, task: GroundTask, grounded: GroundActions, rng: RandomSource
    ) -> Generator[None, None, Engine]:
        """Partial-order search; with a metric two by turns: one ranks by it, the other is for coverage."""
        settings, metric = self._settings, self._problem.metric
        if settings.rankings or not metric or settings.search != "A":
            return (yield from self._searching(task, grounded, settings, rng))
        eager, by_metric = task, replace(settings, rankings=rankings_for(settings, metric))
        if metric == "cost" and settings.action_cost == "unit":
            eager = yield from make_task(self._problem, grounded, "metric")
            by_metric = replace(by_metric, action_cost="metric")
        first = yield from self._searching(eager, grounded, by_metric, rng)
        second = yield from self._searching(task, grounded, replace(settings, rankings=DEFAULT_RANKINGS), rng)
        return Portfolio(first, second, HEAD_START, share=1)

    def _searching(
        self, task: GroundTask, grounded: GroundActions, settings: Settings, rng: RandomSource
    ) -> Generator[None, None, Engine]:
        space = yield from plan_space(task, grounded, settings, rng)
        return BestFirst[Any](space, settings) if settings.search == "A" else Deepening[Any](space, settings)

    def _ground(self) -> Iterator[None]:
        """Grounds the problem unless the cached grounding fits."""
        world, tick_s = static_world(self._problem), self._settings.tolerance_s
        last = self._cache.last
        if last is not None and last.serves(self._problem, world, tick_s):
            return
        for grounded in ground_actions(self._problem, world, tick_s, self._settings.ground_limit):
            if grounded is None:
                yield None
            else:
                self._cache.last = grounded


def plan_space(
    task: GroundTask, grounded: GroundActions, settings: Settings, rng: RandomSource
) -> Generator[None, None, PlanSpace[Any]]:
    """The plan space of the settings: ground, or with variables; yields as a unit of budget is used."""
    if settings.ground:
        return GroundSpace(task, grounded.world, settings, rng)
    from tailor.executive.planning.lifted.task import lifted_task
    from tailor.executive.planning.lifted_space import LiftedSpace

    order = rng if settings.random_open_conditions else None
    lifted = yield from lifted_task(task, grounded.world, settings.action_cost, order)
    return LiftedSpace(lifted, settings, rng)
