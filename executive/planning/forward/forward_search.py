"""Lazy greedy best-first search through states, helpful actions first.

Source: Helmert, The Fast Downward Planning System, JAIR 26 (2006), section 5.2: deferred evaluation, and two queues by
turns, one for the helpful actions, which is preferred after progress.
"""

from __future__ import annotations

import heapq
from collections.abc import Generator, Iterator
from dataclasses import dataclass, field

from tailor.executive.planning.forward.relaxed_plans import RelaxedPlans
from tailor.executive.planning.forward.strips_task import StripsAction, StripsTask

PORTION = 2000  # states: some milliseconds
MAX_ENTRIES = 4_000_000  # of the queues, some 110 bytes each: half a gigabyte
BOOST = 1000  # turns that the helpful actions gain by each progress

Entry = tuple[int, int, int, int]  # estimate of the parent, age, number of the parent, index of the action


@dataclass(slots=True)
class _Queue:
    """Successors that are not yet evaluated; of two queues the one with the lower count has the turn."""

    entries: list[Entry] = field(default_factory=list)
    turns: int = 0


class ForwardSearch:
    """The state of one search; `generated` counts successors, `visited` evaluated states."""

    def __init__(self, strips: StripsTask, state_limit: int) -> None:
        self._strips = strips
        self._limit = state_limit
        self._estimates = RelaxedPlans(strips)
        self._seen: set[int] = set()
        self._evaluated: list[tuple[int, int, int]] = []  # by number: state, number of its parent, index of the action
        self._queues = (_Queue(), _Queue())  # all successors; those by helpful actions
        self._best = 1 << 60  # shortest relaxed plan so far
        self.generated = 0
        self.visited = 0
        self.limit_reached = ""  # why the search ended early

    @property
    def expected_steps(self) -> int:
        """Actions of a relaxed plan from the initial state; 0 if there is none."""
        estimate = self._estimates.estimate(self._strips.initial)
        return estimate.length if estimate else 0

    def run(self) -> Iterator[list[StripsAction] | None]:
        """Evaluates one state per iteration: yields None, and at the end a sequence of actions that reaches the goal.

        Ends without a sequence if there is none, or with `limit_reached` set.
        """
        following: tuple[int, int, int] | None = (self._strips.initial, -1, -1)
        while following is not None:
            state, parent, action = following
            if self._strips.goal_mask & ~state == 0:
                yield self._sequence(parent, action)
                return
            if self.visited >= self._limit:
                self.limit_reached = f"{self._limit} states evaluated"
                return
            if sum(len(queue.entries) for queue in self._queues) > MAX_ENTRIES:
                self.limit_reached = "the queued states take too much memory"
                return
            self._evaluate(state, parent, action)
            yield None
            following = yield from self._next()

    def _evaluate(self, state: int, parent: int, action: int) -> None:
        """Estimates a state and queues its successors, which are not yet computed."""
        number = self.visited
        self.visited += 1
        self._seen.add(state)
        self._evaluated.append((state, parent, action))
        estimate = self._estimates.estimate(state)
        if estimate is None:
            return
        if estimate.length < self._best:
            self._best = estimate.length
            self._queues[1].turns -= BOOST
        for queue, indices in zip(self._queues, (estimate.applicable, estimate.helpful), strict=True):
            for index in indices:
                heapq.heappush(queue.entries, (estimate.length, self.generated, number, index))
                self.generated += 1

    def _next(self) -> Generator[None, None, tuple[int, int, int] | None]:
        """A state that has not been evaluated, with its parent and action; None if there are no more.

        Yields after every PORTION of states that have been: a large state has thousands of ways to the same others.
        """
        passed = 0
        while waiting := [queue for queue in self._queues if queue.entries]:
            passed += 1
            if not passed % PORTION:
                yield
            queue = min(waiting, key=lambda queue: queue.turns)
            queue.turns += 1
            _, _, parent, action = heapq.heappop(queue.entries)
            state = self._strips.actions[action].after(self._evaluated[parent][0])
            if state not in self._seen:
                return state, parent, action
        return None

    def _sequence(self, parent: int, action: int) -> list[StripsAction]:
        """The actions from the initial state."""
        actions = []
        while action >= 0:
            actions.append(self._strips.actions[action])
            _, parent, action = self._evaluated[parent]
        return actions[::-1]
