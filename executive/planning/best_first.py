"""A* through plan space, with several flaw orders that take turns, each with a queue of its own.

Source: Younes & Simmons, JAIR 20 (2003), section 4.4. No closed list: two ways to one plan count twice.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Generic

from tailor.executive.planning.plan_space import P, PlanSpace
from tailor.executive.planning.plans.plan import Result, dead_end, unreachable
from tailor.executive.planning.settings import FlawOrder, Settings

FIRST_TURN = 1000  # plans that a flaw order has generated when the next one's turn comes; doubles with every round

MAX_ENTRIES = 40_000_000  # of the orderings of a queue's plans, 10 to 20 bytes each: half a gigabyte, seldom more

Ranked = tuple[Any, ...]  # a rank with its plan as one more item: one flat tuple is compared faster than two nested


@dataclass(slots=True)
class _Queue:
    """The plans that wait for one flaw order."""

    order: int
    limit: float
    plans: list[Ranked] = field(default_factory=list)
    generated: int = 0

    def exhausted(self) -> bool:
        """Whether the order has generated all that it may."""
        return self.generated >= self.limit


class BestFirst(Generic[P]):
    """The state of one search; `generated` and `visited` count plans as VHPOP does."""

    def __init__(self, space: PlanSpace[P], settings: Settings) -> None:
        self._space = space
        self._limit = settings.node_limit
        self._steps = settings.step_limit
        self._too_long = False  # whether a plan was left out for its length: then running dry proves nothing
        self._orders: tuple[FlawOrder, ...] = settings.flaw_orders
        self.generated = 0
        self.visited = 0

    def run(self) -> Iterator[Result | None]:
        """Works on one plan per iteration; yields None until the result."""
        start = self._space.initial()
        rank = self._space.rank(start, 0)
        if rank is None:
            yield unreachable()
            return
        limits = [math.inf if order.limit is None else order.limit for order in self._orders]
        queues = [_Queue(n, limit, [(*rank, start)]) for n, limit in enumerate(limits)]
        turn = FIRST_TURN
        while queues:
            for queue in list(queues):
                yield from self._work(queue, turn if len(queues) > 1 else math.inf)
                if queue.exhausted():
                    queues.remove(queue)
            turn *= 2
        yield self._limited("every flaw order has reached its limit of generated plans")

    def _work(self, queue: _Queue, turn: float) -> Iterator[Result | None]:
        """Works with one flaw order until it has generated as many plans as its turn allows."""
        space, plans = self._space, queue.plans
        if queue.generated == 0:  # its first turn: the initial plan counts for every order that sets to work
            queue.generated = 1
            self.generated += 1
        end = min(queue.limit, turn)
        while queue.generated < end:
            if not plans:
                yield dead_end(self._too_long, self._steps, self.generated, self.visited)
                return
            if self.generated >= self._limit:
                yield self._limited(f"{self._limit} plans generated")
                return
            plan: P = heapq.heappop(plans)[-1]
            if len(plans) * plan.orderings.entries > MAX_ENTRIES:  # the others are about as large
                yield self._limited("the plans that wait take too much memory")
                return
            if len(plan.steps) > self._steps:
                self._too_long = True
                continue
            if plan.open is None and plan.threats is None and space.complete(plan):
                yield Result("solved", space.extract(plan), "", self.generated, self.visited)
                return
            self.visited += 1
            queue.generated += self._push(space.refine(plan, queue.order), plans)
            yield None

    def _push(self, children: list[P], plans: list[Ranked]) -> int:
        """Pushes the plans that a solution may come of; returns how many."""
        rank, number = self._space.rank, self.generated
        for child in children:
            ranked = rank(child, number)
            if ranked is not None:
                heapq.heappush(plans, (*ranked, child))
                number += 1
        pushed = number - self.generated
        self.generated = number
        return pushed

    def _limited(self, reason: str) -> Result:
        return Result("limit", None, reason, self.generated, self.visited)
