"""The FF heuristic: length of a plan that ignores what actions make false, and the actions it begins with.

Sources: Hoffmann & Nebel, JAIR 14 (2001): relaxed plans and helpful actions. Each literal's supporter is its cheapest
by the additive heuristic (Keyder & Geffner, ECAI 2008), not the first by level: relaxed plans become shorter. As in FF
an action of the relaxed plan serves other needs, too; costs take the place of levels.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass

from tailor.executive.planning.forward.strips_task import StripsTask
from tailor.executive.planning.plans.schedule import bits_of

UNREACHED = 1 << 60  # cost of a literal
MOST = 1 << 50  # cost of a reached one: a chain of n actions with two conditions each costs 2 ** n


@dataclass(frozen=True, slots=True)
class Estimate:
    """Number of actions of a relaxed plan, and by index in ascending order those that are applicable at once.

    `helpful` are the ones that belong to the relaxed plan.
    """

    length: int
    applicable: tuple[int, ...]
    helpful: tuple[int, ...]


class RelaxedPlans:
    """Estimates of states of one task."""

    def __init__(self, strips: StripsTask) -> None:
        self._strips = strips
        self._counts = [len(action.needs) for action in strips.actions]
        self._free = [index for index, action in enumerate(strips.actions) if not action.needs]
        self._users: list[list[int]] = [[] for _ in range(strips.literals)]
        for index, action in enumerate(strips.actions):
            for literal in action.needs:
                self._users[literal].append(index)

    def estimate(self, state: int) -> Estimate | None:
        """The estimate of a state; None if not even a relaxed plan reaches the goal."""
        applicable, supporters, costs = self._supporters(state)
        if supporters is None:
            return None
        chosen = self._relaxed_plan(supporters, costs)
        return Estimate(len(chosen), applicable, tuple(index for index in applicable if index in chosen))

    def _relaxed_plan(self, supporters: Sequence[int], costs: Sequence[int]) -> set[int]:
        """The supporters of the goal and of their own needs, the most expensive consumer's first.

        What an action of the plan makes serves every consumer that costs at least as much: no action depends on one
        of its own cost or above, so the plan stays free of cycles. E.g. the place where a cup is put for the goal also
        frees the hand for the next cup.
        """
        actions, chosen = self._strips.actions, set[int]()
        made: dict[int, int] = {}  # least cost of an action of the plan that makes a literal
        pending = [(-UNREACHED, literal) for literal in self._strips.goal]  # the consumer's cost, negated
        heapq.heapify(pending)
        while pending:
            consumer, literal = heapq.heappop(pending)
            supporter, cost = supporters[literal], costs[literal]
            if supporter < 0 or supporter in chosen or made.get(literal, UNREACHED + 1) <= -consumer:
                continue
            chosen.add(supporter)
            for other in actions[supporter].made:
                made[other] = min(cost, made.get(other, cost))
            for need in actions[supporter].needs:
                heapq.heappush(pending, (-cost, need))
        return chosen

    def _supporters(self, state: int) -> tuple[tuple[int, ...], list[int] | None, list[int]]:
        """The applicable actions, the cheapest one that makes each literal true, -1 where it holds, and its cost.

        None instead of the second if a literal of the goal has none.

        Literals are closed in the order of their additive cost, bucket by bucket, until all of the goal are.
        """
        actions, users = self._strips.actions, self._users
        costs, supporters = [UNREACHED] * self._strips.literals, [-1] * self._strips.literals
        missing, sums = self._counts.copy(), [1] * len(actions)
        buckets: dict[int, list[int]] = {0: bits_of(state)}
        queue = [0]  # the costs of buckets: there are far fewer than costs
        for literal in buckets[0]:
            costs[literal] = 0
        unmet = self._strips.goal_mask & ~state
        applicable: tuple[int, ...] = ()

        def fire(index: int) -> None:
            cost = min(sums[index], MOST)
            for literal in actions[index].made:
                if cost < costs[literal]:
                    costs[literal], supporters[literal] = cost, index
                    if (bucket := buckets.get(cost)) is None:
                        bucket = buckets[cost] = []
                        heapq.heappush(queue, cost)
                    bucket.append(literal)

        for index in self._free:
            fire(index)
        while queue:
            cost = heapq.heappop(queue)
            for literal in buckets[cost]:  # the last bucket grows meanwhile
                if costs[literal] != cost:
                    continue  # closed before at a lower cost
                unmet &= ~(1 << literal)
                for index in users[literal]:
                    missing[index] -= 1
                    sums[index] += cost
                    if not missing[index]:
                        fire(index)
            if cost == 0:  # what holds
                applicable = tuple(index for index, number in enumerate(missing) if not number)
            if not unmet:
                return applicable, supporters, costs
        return applicable, None, costs
