"""Keeps interfering events apart: as early as possible, events that no ordering relates may fall on the same time.

Causal links separate those that the plan needs; here are the others: conditions of effects that it does not need,
alternatives that it did not choose.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from tailor.executive.planning.ground_plans.events import Event
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.structures.orderings import FIRST, GOAL, Orderings
from tailor.executive.planning.structures.temporal_network import TemporalNetwork

Pair = tuple[int, int]  # nodes, the first before the second
Choices = list[tuple[Pair, bool]]  # orderings that were added, and whether their opposites are left to try
Simulation = Callable[[TemporalNetwork], Work[str]]  # of a schedule, as early as possible: "" if it is sound
MAX_REVISED = 200  # orderings added once more after a wrong choice: some milliseconds, nearly all plans need none
MAX_PORTIONS = 640  # of simulations of one plan, nearly all the events of one time: twenty milliseconds


class UnsettledError(Exception):
    """The choices between the orders of interfering events that were tried do not tell whether there is a schedule."""


class Schedule(NamedTuple):
    """Orderings with interfering events apart; whether those of no other choice have a smaller makespan."""

    orderings: Orderings
    is_shortest: bool = True


def separated(orderings: TemporalNetwork, events: Sequence[Event], simulate: Simulation) -> Schedule | None:
    """The orderings with more of them, so that interfering events are a tick apart at their earliest times.

    Of several the ones with the least makespan, among as many as MAX_REVISED allows.

    Args:
      orderings: Of a plan without flaws: either order of two events that they do not relate is sound.
      events: The events, in the order of their nodes.
      simulate: Tells whether events that may interfere do: they may stay together where their effects do not happen.

    Returns:
      None if there is no such schedule.

    Raises:
      UnsettledError: Too many choices failed, or events were kept apart whose effects may not happen.
    """
    return _Separation(orderings, events, simulate).schedule()


class _Separation:
    """A depth-first search through the orders of events that interfere."""

    def __init__(self, orderings: TemporalNetwork, events: Sequence[Event], simulate: Simulation) -> None:
        self._orderings = orderings
        self._events = events
        self._certain = [event.certain() for event in events]
        self._simulate = simulate
        self._portions = 0  # of simulations so far
        self._chosen: Choices = []
        self._shortest: TemporalNetwork | None = None
        self._skipped = math.inf  # least makespan of the orderings that were left without all of their schedules

    def schedule(self) -> Schedule | None:
        """See `separated`."""
        revised, least = 0, makespan(self._orderings)
        network: TemporalNetwork | None = self._orderings
        while network is not None:
            network = self._further(network)
            if network is None and self._best() > least:
                revised += len(self._chosen)
                if revised > MAX_REVISED:
                    self._skipped = least
                    break
                network = _with_last_reversed(self._orderings, self._chosen)
        if self._shortest is None:
            if self._skipped < math.inf:
                raise UnsettledError
            return None
        return Schedule(self._shortest, self._best() <= self._skipped)

    def _best(self) -> float:
        return math.inf if self._shortest is None else makespan(self._shortest)

    def _further(self, network: TemporalNetwork) -> TemporalNetwork | None:
        """The orderings with two more events apart; None if they are a schedule, or lead to none that is shorter."""
        if makespan(network) >= self._best():
            return None
        pair, is_certain = self._coincident(network)
        if pair is None or (not is_certain and self._is_sound(network)):
            self._shortest = network
            return None
        if not is_certain:  # at other times the two may happen together
            self._skipped = min(self._skipped, makespan(network))
        return _with_pair(network, pair, self._chosen)

    def _coincident(self, network: TemporalNetwork) -> tuple[Pair | None, bool]:
        """The nodes of the first two events that are less than a tick apart and interfere, and whether they must.

        Only if there are no such two, those that may.
        """
        times, events, certain = network.earliest(), self._events, self._certain
        nodes = sorted(range(FIRST, FIRST + len(events)), key=lambda node: (times[node], node))
        possible: Pair | None = None
        for n, a in enumerate(nodes):
            for b in nodes[n + 1 :]:
                if times[b] - times[a] >= network.tick:
                    break
                if events[a - FIRST].interferes(events[b - FIRST]):
                    if certain[a - FIRST].interferes(certain[b - FIRST]):
                        return (a, b), True
                    possible = possible or (a, b)
        return possible, False

    def _is_sound(self, network: TemporalNetwork) -> bool:
        """Whether no events interfere at their earliest times; False where that takes too long to tell."""
        work = self._simulate(network)
        while self._portions < MAX_PORTIONS:
            self._portions += 1
            try:
                next(work)
            except StopIteration as ended:
                fault: str = ended.value
                return not fault
        return False


def makespan(orderings: Orderings) -> float:
    """The earliest time of the goal."""
    return orderings.earliest()[GOAL]


def _with_pair(network: TemporalNetwork, pair: Pair, chosen: Choices) -> TemporalNetwork | None:
    """The orderings with one of two events before the other, in the order given if that fits; None if none does."""
    a, b = pair
    if (further := network.ordered(a, b)) is not None:
        chosen.append(((a, b), True))
    elif (further := network.ordered(b, a)) is not None:
        chosen.append(((b, a), False))
    return further


def _with_last_reversed(orderings: TemporalNetwork, chosen: Choices) -> TemporalNetwork | None:
    """The orderings with the choices up to the last one whose opposite is left to try, reversed; None if none is."""
    while chosen:
        (a, b), is_open = chosen.pop()
        if not is_open:
            continue
        chosen.append(((b, a), False))
        network: TemporalNetwork | None = orderings
        for pair, _ in chosen:
            network = network.ordered(*pair) if network is not None else None
        if network is not None:
            return network
    return None
