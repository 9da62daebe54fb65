"""A lower bound on the makespan of a partial plan: how long its steps occupy a group of exclusive facts in all.

While a causal link keeps a fact, no other fact of its group holds and no step is between two of them. So the times of
a group's links, its steps and what its open conditions need at least add up, however the steps may be ordered.
"""

from __future__ import annotations

from collections import defaultdict

from tailor.executive.planning.bounds.exclusive_facts import ExclusiveFacts, Group
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.partial_plan import PartialPlan
from tailor.executive.planning.structures.orderings import GOAL
from tailor.executive.planning.structures.temporal_network import TemporalNetwork


class Occupation:
    """The bounds of one task's plans."""

    def __init__(self, task: GroundTask, exclusive: ExclusiveFacts) -> None:
        self._initial = task.initial
        self._exclusive = exclusive

    @property
    def applies(self) -> bool:
        """Whether the task has groups of exclusive facts."""
        return bool(self._exclusive.groups)

    def bound(self, plan: PartialPlan) -> int:
        """The least makespan of all plans below, in units of the time grid."""
        network = plan.orderings
        assert isinstance(network, TemporalNetwork)
        total: defaultdict[Group, int] = defaultdict(int)
        moves, groups, ways = self._exclusive.moves, self._exclusive.groups, self._exclusive.ways
        for action in plan.steps:
            for group, time in moves[action.number].items():
                total[group] += time
        kept = self._kept(plan, network)
        for literal in self._needed(plan, network, kept):
            for group in groups[literal]:
                total[group] += ways[literal].get(group, 0)
        for literal, time in kept.items():
            for group in groups[literal]:
                total[group] += time
        return max(total.values(), default=0)

    def _kept(self, plan: PartialPlan, network: TemporalNetwork) -> dict[int, int]:
        """How long causal links keep each fact in all: the links of one producer are at the same time."""
        rows, groups = network.rows, self._exclusive.groups
        longest: dict[tuple[int, int], int] = {}
        cell = plan.links
        while cell is not None:
            producer, literal, _, last, cell = cell
            if literal in groups and last != GOAL:
                time = -rows[producer][last]  # rows[a][b] is the greatest t_a - t_b
                if time > longest.get((producer, literal), 0):
                    longest[producer, literal] = time
        kept: dict[int, int] = {}
        for (_, literal), time in longest.items():
            kept[literal] = kept.get(literal, 0) + time
        return kept

    def _needed(self, plan: PartialPlan, network: TemporalNetwork, kept: dict[int, int]) -> set[int]:
        """The facts that only further steps can make true; raises `kept` to what the open conditions need.

        A link of theirs will begin a tick before its consumer at least, or at the consumer's own start.
        """
        groups, made, rows = self._exclusive.groups, plan.effects.masks(), network.rows
        needed = set()
        cell = plan.open
        while cell is not None:
            literal, first, last, cell = cell
            if literal.__class__ is int and literal in groups:
                time = 0 if last == GOAL else -rows[first][last]
                if not made[literal] >> first & 1:
                    time += network.tick if last != GOAL else 0
                if time > kept.get(literal, 0):
                    kept[literal] = time
                if not made[literal] and literal not in self._initial:
                    needed.add(literal)
        return needed
