"""Groups of facts of which at most one holds at a time, such as the places of a robot, or that it is free.

The facts of a group differ in one argument at most. At most one holds initially, and every action that adds one takes
one before: it requires a fact of the group and deletes it, at the same moment or earlier. In between none holds. So
the steps of a plan occupy such a group one after the other, whatever they do besides.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.additive_heuristic import PORTION
from tailor.executive.planning.ground.ground_action import GroundAction
from tailor.executive.planning.ground.ground_task import GroundTask

Group = tuple[int, Fact]  # the argument in which the facts differ, then the rest; 0: a single fact
Groups = dict[int, tuple[Group, ...]]  # by literal
Times = dict[Group, int]  # in units of the grid


@dataclass(frozen=True, slots=True)
class ExclusiveFacts:
    """The groups of each fact, and how long actions are between two facts of a group.

    `moves` has, by action number, the least time during which a step takes a fact of each group and has not yet added
    one; `ways`, by literal, the least such time of all actions that add it.
    """

    groups: Groups
    moves: dict[int, Times]
    ways: dict[int, Times]


def exclusive_facts(task: GroundTask) -> Generator[None, None, ExclusiveFacts]:
    """The groups of a task in which actions take time; yields after every PORTION of facts or effects."""
    groups: Groups = {}
    for literal in range(0, len(task.names), 2):
        fact = task.names[literal].fact
        groups[literal] = ((0, fact), *((n, fact[:n] + fact[n + 1 :]) for n in range(1, len(fact))))
        if literal % PORTION == PORTION - 2:
            yield
    moves = yield from _moves(task, groups)
    refuted = {group for times in moves.values() for group, time in times.items() if time < 0}
    refuted.update(group for literal, _ in task.timed for group in groups.get(literal, ()))
    initial: set[Group] = set()
    for literal in task.initial & groups.keys():
        refuted.update(initial.intersection(groups[literal]))
        initial.update(groups[literal])
    ways: dict[int, Times] = {}
    for literal, own in groups.items():
        groups[literal] = left = tuple([group for group in own if group not in refuted])
        added = [moves[action.number] for action, _ in task.achievers[literal]]
        ways[literal] = {group: min(times[group] for times in added) for group in left} if added else {}
        if literal % PORTION == PORTION - 2:
            yield
    for number, times in moves.items():
        moves[number] = {group: time for group, time in times.items() if time > 0 and group not in refuted}
    return ExclusiveFacts({literal: own for literal, own in groups.items() if own}, moves, ways)


def _moves(task: GroundTask, groups: Groups) -> Generator[None, None, dict[int, Times]]:
    """The times of all reachable actions, by number; -1 for a group that an action refutes."""
    moves: dict[int, Times] = {}
    done = 0
    for achievers in task.achievers:
        for action, _ in achievers:
            if action.number not in moves:
                moves[action.number] = _times(action, groups)
                done += len(action.effects)
        if done >= PORTION:
            done = 0
            yield
    return moves


def _times(action: GroundAction, groups: Groups) -> Times:
    """Of each group of which the action adds a fact the least time from taking one; -1 if it may add without taking."""
    taken: Times = {}  # the first moment
    for effect in action.effects:
        fact = effect.literal ^ 1
        required = any(part == fact and effect.moment in span for part, span in action.conditions)
        if fact in groups and required and not effect.conditions:
            for group in groups[fact]:
                taken[group] = min(effect.moment, taken.get(group, 1))
    times: Times = {}
    for effect in action.effects:
        for group in groups.get(effect.literal, ()):
            early = group in taken and taken[group] <= effect.moment
            if group in times or not early:  # one fact is taken, so a second one must not be added
                times[group] = -1
            else:
                times[group] = action.shortest if taken[group] < effect.moment else 0
    return times
