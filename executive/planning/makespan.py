"""An optimistic makespan of a partial plan: no step starts before its open conditions can hold."""

from __future__ import annotations

from executive.planning.ground_task import GroundTask
from executive.planning.orderings import GOAL, INITIAL
from executive.planning.partial_plan import PartialPlan
from executive.planning.temporal_network import UNBOUNDED, TemporalNetwork


def makespan_estimate(plan: PartialPlan, task: GroundTask) -> float:
    """The makespan in ticks (in levels without durations) that the orderings and the relaxed graph allow at least."""
    earliest = _earliest_conditions(plan, task)
    if isinstance(plan.orderings, TemporalNetwork):
        return _over_network(plan.orderings, earliest)
    return _over_levels(plan, earliest)


def _earliest_conditions(plan: PartialPlan, task: GroundTask) -> dict[int, float]:
    """By node, the earliest time at which its open conditions can hold."""
    times: dict[int, float] = {}
    cell = plan.open
    while cell is not None:
        time = task.estimates.of(cell.condition).makespan
        times[cell.first] = max(time, times.get(cell.first, 0))
        cell = cell.rest
    return times


def _over_network(network: TemporalNetwork, earliest: dict[int, float]) -> float:
    makespan = max(network.earliest()[GOAL], earliest.get(GOAL, 0))
    for node, time in earliest.items():
        if node != GOAL:
            row = network.rows[node]  # row[other]: greatest t_node - t_other, so t_other >= time - row[other]
            for bound in (row[other] for other in range(len(row)) if other not in (INITIAL, GOAL)):
                if bound < UNBOUNDED // 2:
                    makespan = max(makespan, time - bound)
    return makespan


def _over_levels(plan: PartialPlan, earliest: dict[int, float]) -> float:
    """The longest chain of unit steps, each lifted to the level that its open conditions need."""
    late = plan.orderings.late
    levels: dict[int, float] = {}
    for node in sorted(range(len(late)), key=lambda n: -late[n].bit_count()):
        before = [level for other, level in levels.items() if late[other] >> node & 1]
        levels[node] = max([earliest.get(node, 0), *before]) + (node not in (INITIAL, GOAL))
    return levels[GOAL]
