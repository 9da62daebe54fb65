"""One planning problem from grounding to result: resumable, one budget check per plan worked on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.planning.best_first import BestFirst
from tailor.executive.planning.deepening import Deepening
from tailor.executive.planning.ground.ground_formula import TooMuchToGround
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import GroundActions, ground_actions, shuffled, world_of
from tailor.executive.planning.lifted.task import lifted_task
from tailor.executive.planning.lifted_space import LiftedSpace
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plan_space import GroundSpace, P, PlanSpace
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.settings import DEFAULT, Settings


class GroundCache:
    """Keeps the last grounding, which serves again while domain, objects and static facts stand."""

    def __init__(self) -> None:
        self.last: GroundActions | None = None


class Search:
    """A search for a plan, advanced by as much as each tick can spare."""

    def __init__(
        self, domain: Domain, problem: Problem, settings: Settings = DEFAULT, ground: GroundCache | None = None
    ) -> None:
        """Prepares; all work is done in `advance`.

        Args:
          domain: The problem's domain.
          problem: What to solve.
          settings: Rankings, flaw orders, limits.
          ground: Hand in the same one when replanning: grounding is skipped while the world stands.
        """
        assert problem.domain == domain, "the problem is of another domain"
        self._problem = problem
        self._settings = settings
        self._cache = ground if ground is not None else GroundCache()
        self._algorithm: BestFirst[Any] | Deepening[Any] | None = None
        self._work = self._run()
        self._result: Result | None = None

    @property
    def counts(self) -> tuple[int, int]:
        """Plans generated and visited so far."""
        return (self._algorithm.generated, self._algorithm.visited) if self._algorithm else (0, 0)

    def advance(self, budget: Budget) -> Result | None:
        """Goes on until there is a result or the budget is spent (None: call again later)."""
        while self._result is None and not budget.spent():
            self._result = next(self._work)
        return self._result

    def _run(self) -> Iterator[Result | None]:
        settings = self._settings
        rng = np.random.default_rng(settings.seed)
        try:
            yield from self._ground()
            grounded = self._cache.last
            assert grounded is not None
            if settings.random_open_conditions:
                grounded = shuffled(grounded, rng)
            task = make_task(self._problem, grounded, settings.action_cost)
            if settings.ground:
                yield from self._explore(GroundSpace(task, grounded.world, settings, rng))
            else:
                order = rng if settings.random_open_conditions else None
                lifted = lifted_task(task, grounded.world, settings.action_cost, order)
                yield from self._explore(LiftedSpace(lifted, settings, rng))
        except TooMuchToGround as reason:
            yield Result("limit", None, str(reason), *self.counts)

    def _explore(self, space: PlanSpace[P]) -> Iterator[Result | None]:
        algorithm = (
            BestFirst(space, self._settings) if self._settings.search == "A" else Deepening(space, self._settings)
        )
        self._algorithm = algorithm
        yield from algorithm.run()

    def _ground(self) -> Iterator[None]:
        """Grounds the problem's world unless the cache has it."""
        world, tick_s = world_of(self._problem), self._settings.tolerance_s
        last = self._cache.last
        if last is not None and last.world == world and last.tick_s == tick_s:
            return
        for grounded in ground_actions(world, tick_s, self._settings.ground_limit):
            if grounded is None:
                yield None
            else:
                self._cache.last = grounded
