"""A* through plan space with several flaw orders in round robin, each with its own queue.

Source: Younes & Simmons, JAIR 20 (2003), section 4.4. No closed list: a plan that is reached twice counts twice.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field
from typing import Any, Generic

from tailor.executive.planning.plan_space import P, PlanSpace
from tailor.executive.planning.plans.plan import Result
from tailor.executive.planning.results import goal_unreachable, search_exhausted
from tailor.executive.planning.settings import FlawOrder, Settings

INITIAL_QUOTA = 1000  # plans that each flaw order generates in the first round; doubles with every round

MAX_ENTRIES = 40_000_000  # of the orderings of a queue's plans, 10 to 20 bytes each: half a gigabyte, seldom more

RANKED_AT_ONCE = 20_000  # open conditions of the plans ranked between two units of budget: two milliseconds

Ranked = tuple[Any, ...]  # a rank with its plan as last item: one flat tuple is compared faster than two nested


@dataclass(slots=True)
class _Queue:
    """Plans queued for one flaw order."""

    order: int
    limit: float
    plans: list[Ranked] = field(default_factory=list)
    generated: int = 0

    def is_exhausted(self) -> bool:
        """Whether the flaw order has generated as many plans as its own limit allows."""
        return self.generated >= self.limit


class BestFirst(Generic[P]):
    """The state of one A* search; `generated` and `visited` count plans as VHPOP does."""

    def __init__(self, space: PlanSpace[P], settings: Settings) -> None:
        self._space = space
        self._limit = settings.node_limit
        self._step_limit = settings.step_limit
        self._pruned = False  # whether a plan was dropped for its length: an empty queue then proves nothing
        self._orders: tuple[FlawOrder, ...] = settings.flaw_orders
        self.generated = 0
        self.visited = 0
        self.is_hopeless: Callable[[P], bool] | None = None  # of an anytime search: the plan leads to none better
        self.max_entries = MAX_ENTRIES
        self.goes_on = False  # whether the search continues after a plan

    def run(self) -> Iterator[Result | None]:
        """Refines one plan per iteration; yields None until the result."""
        start = self._space.initial()
        rank = self._space.rank(start, 0)
        if rank is None:
            yield goal_unreachable()
            return
        limits = [math.inf if order.limit is None else order.limit for order in self._orders]
        queues = [_Queue(n, limit, [(*rank, start)]) for n, limit in enumerate(limits)]
        quota = INITIAL_QUOTA
        while queues:
            for queue in list(queues):
                yield from self._work(queue, quota if len(queues) > 1 else math.inf)
                if queue.is_exhausted():
                    queues.remove(queue)
            quota *= 2
        yield self._limit_reached("every flaw order has reached its limit of generated plans")

    def _work(self, queue: _Queue, quota: float) -> Iterator[Result | None]:
        """Refines plans with one flaw order until it has generated its quota."""
        space, plans = self._space, queue.plans
        if queue.generated == 0:  # first round: the initial plan counts once per flaw order that starts
            queue.generated = 1
            self.generated += 1
        end = min(queue.limit, quota)
        while queue.generated < end:
            if not plans:
                gap = space.gap()
                yield search_exhausted(gap, self._pruned, self._step_limit, self.generated, self.visited)
                return
            if self.generated >= self._limit:
                yield self._limit_reached(f"{self._limit} plans generated")
                return
            plan: P = heapq.heappop(plans)[-1]
            if len(plans) * plan.orderings.entries > self.max_entries:  # the others are about as large
                yield self._limit_reached("the queued plans take too much memory")
                return
            if len(plan.steps) > self._step_limit:
                self._pruned = True
                continue
            if self.is_hopeless is not None and self.is_hopeless(plan):
                yield None
                continue
            if plan.open is None and plan.threats is None and space.is_complete(plan):
                yield Result("solved", space.extract(plan), "", self.generated, self.visited)
                if not self.goes_on:
                    return
                continue
            self.visited += 1
            children = space.refine(plan, queue.order)
            if len(children) * plan.open_count > RANKED_AT_ONCE:
                children = yield from self._push_portions(children, queue, RANKED_AT_ONCE // plan.open_count or 1)
            queue.generated += self._push(children, plans, queue.limit - queue.generated)
            yield None

    def _push_portions(self, children: list[P], queue: _Queue, portion: int) -> Generator[None, None, list[P]]:
        """Pushes all plans but the last portion, which it returns; yields after each portion."""
        while len(children) > portion:
            queue.generated += self._push(children[:portion], queue.plans, queue.limit - queue.generated)
            children = children[portion:]
            yield None
        return children

    def _push(self, children: list[P], plans: list[Ranked], most: float) -> int:
        """Pushes the plans of finite rank, at most so many; returns their number."""
        rank, number = self._space.rank, self.generated
        most += number
        for child in children:
            ranked = rank(child, number)
            if ranked is not None and number < most:
                heapq.heappush(plans, (*ranked, child))
                number += 1
        pushed = number - self.generated
        self.generated = number
        return pushed

    def _limit_reached(self, reason: str) -> Result:
        return Result("limit", None, reason, self.generated, self.visited)
