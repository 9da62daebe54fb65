"""Lower bound on the makespan of a partial plan: no step starts before its open conditions can hold."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.executive.planning.structures.orderings import GOAL, INITIAL, Closure, Orderings
from tailor.executive.planning.structures.temporal_network import UNBOUNDED, TemporalNetwork


def makespan_estimate(orderings: Orderings, conditions: Iterable[tuple[int, float]]) -> float:
    """The least makespan in ticks (in levels without durations).

    Args:
      orderings: Orderings of the plan.
      conditions: Of each open condition its node, and the earliest time at which it can hold.
    """
    earliest: dict[int, float] = {}
    for node, time in conditions:
        earliest[node] = max(time, earliest.get(node, 0))
    if isinstance(orderings, TemporalNetwork):
        return _over_network(orderings, earliest)
    assert isinstance(orderings, Closure)
    return orderings.levels(earliest)[GOAL]


def _over_network(network: TemporalNetwork, earliest: dict[int, float]) -> float:
    makespan = max(network.earliest()[GOAL], earliest.get(GOAL, 0))
    for node, time in earliest.items():
        if node != GOAL:
            # row[other] is the greatest t_node - t_other, so t_other is at least time - row[other]
            for other, bound in enumerate(network.rows[node]):
                if other not in (INITIAL, GOAL) and bound < UNBOUNDED // 2:
                    makespan = max(makespan, time - bound)
    return makespan
