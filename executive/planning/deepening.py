"""IDA*: depth-first search up to a bound on the first quantity of the rank.

When a round is exhausted, the bound rises to the least value beyond it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Generic

from tailor.executive.planning.flaws.ranking import Rank
from tailor.executive.planning.plan_space import P, PlanSpace
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.results import goal_unreachable, search_exhausted
from tailor.executive.planning.settings import Settings


class Deepening(Generic[P]):
    """The state of one IDA* search: a stack instead of a queue; every round generates the plans again.

    Flaw orders follow one another: the next starts when the one before has reached its limit.
    """

    def __init__(self, space: PlanSpace[P], settings: Settings) -> None:
        self._space = space
        self._settings = settings
        self.generated = 1
        self.visited = 0
        self._pruned = False

    def run(self) -> Iterator[Result | None]:
        """Refines one plan per iteration; yields None until the result."""
        start = self._space.initial()
        rank = self._space.rank(start, 0)
        if rank is None:
            yield goal_unreachable()
            return
        for number, order in enumerate(self._settings.flaw_orders):
            limit = self.generated + order.limit if order.limit is not None else math.inf
            yield from self._deepen(start, rank, number, min(limit, self._settings.node_limit))
            if self.generated >= self._settings.node_limit:
                break
        yield Result("limit", None, f"{self.generated} plans generated", self.generated, self.visited)

    def _deepen(self, start: P, rank: Rank, order: int, limit: float) -> Iterator[Result | None]:
        bound = rank[0]
        while bound < math.inf:
            stack = [(rank, start)]
            beyond = math.inf
            while stack:
                if self.generated >= limit:
                    return
                _, plan = stack.pop()
                if plan.open is None and plan.threats is None and self._space.is_complete(plan):
                    yield Result("solved", self._space.extract(plan), "", self.generated, self.visited)
                    return
                self.visited += 1
                for other in self._children(plan, order):
                    if other[0][0] > bound:
                        beyond = min(beyond, other[0][0])
                    else:
                        stack.append(other)
                yield None
            bound = beyond
        gap, most = self._space.gap(), self._settings.step_limit
        yield search_exhausted(gap, self._pruned, most, self.generated, self.visited)

    def _children(self, plan: P, order: int) -> list[tuple[Rank, P]]:
        """The children with their ranks, the best last: it is refined first."""
        children = []
        for child in self._space.refine(plan, order):
            rank = self._space.rank(child, self.generated)
            if rank is None:
                continue
            if len(child.steps) > self._settings.step_limit:
                self._pruned = True
                continue
            children.append((rank, child))
            self.generated += 1
        return sorted(children, key=lambda ranked: ranked[0], reverse=True)
