"""The additive heuristic on the relaxed planning graph: cost, work and makespan of reaching every literal.

Source: Bonet & Geffner 2001; in plan space Younes & Simmons, JAIR 20 (2003), section 4. Actions count as wholes; where
these reach no more, starts alone are tried: what an action changes at its start serves actions beside it, and its own
end, before its later conditions hold.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from tailor.executive.planning.ground.ground_action import GroundAction, Span
from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.structures.connectives import Conjunction

Spanned = Iterable[tuple[GroundCondition, Span]]


class Value(NamedTuple):
    """An estimate: cost of the actions, planning work (flaws to resolve), makespan in ticks or unit steps."""

    cost: float
    work: float
    makespan: float


UNREACHABLE = Value(math.inf, math.inf, math.inf)
MOST = 1e200  # cost and work of a reached literal: a chain of n actions with two conditions each costs 2 ** n
INITIAL = Value(0, 1, 0)  # a link from the initial state costs no action, but one unit of work
NOTHING = Value(0, 0, 0)
PORTION = 4096  # actions relaxed or entered per unit of budget: ten milliseconds; small tasks take one unit in all
LITERALS_PER_ACTION = 8  # of more the action counts as several: one quantified condition may have thousands


@dataclass(frozen=True, slots=True)
class Estimates:
    """The values of all literals, and the numbers of the reachable actions level by level of the graph."""

    values: tuple[Value, ...]
    cost: tuple[float, ...]
    work: tuple[float, ...]
    reached: tuple[int, ...]

    def of(self, condition: GroundCondition) -> Value:
        """The value of a condition: sums over conjunctions, the cheapest part of a disjunction."""
        return _value(condition, self.values)

    def reaches(self, conditions: Spanned) -> bool:
        """Whether all conditions are reachable in the relaxed graph."""
        return all(self.of(condition).cost < math.inf for condition, _ in conditions)


def _value(condition: GroundCondition, values: Sequence[Value]) -> Value:
    if isinstance(condition, int):
        return values[condition]
    parts = [_value(part, values) for part in condition.parts]
    return sum_of(parts) if isinstance(condition, Conjunction) else min(parts, default=UNREACHABLE)


def sum_of(parts: Iterable[Value]) -> Value:
    """Costs and work are added; the makespan is the maximum, as parts may run in parallel."""
    cost, work, makespan = NOTHING
    for part in parts:
        cost += part.cost
        work += part.work
        makespan = max(makespan, part.makespan)
    return Value(cost, work, makespan)


def action_costs(actions: Sequence[tuple[float, float]], kind: str) -> tuple[float, ...]:
    """The cost of each action: 1, its duration in seconds, that relative to the shortest one, or the metric's.

    Args:
      actions: Of each the metric's cost, and its shortest duration in seconds.
      kind: See `Settings.action_cost`.
    """
    if kind == "metric":
        return tuple(cost for cost, _ in actions)
    durations = [duration_s or 1.0 for _, duration_s in actions]
    if kind == "unit" or not durations:
        return (1,) * len(durations)
    unit = min(durations) if kind == "relative" else 1.0
    return tuple(duration / unit for duration in durations)


def estimate(
    actions: Sequence[GroundAction], costs: Sequence[float], initial: Iterable[int], count: int
) -> Generator[None, None, Estimates]:
    """The fixpoint of the relaxed planning graph; each level is computed from the values of the one before.

    Yields after every PORTION of actions, those with many literals counted as several, and returns the estimates.

    Args:
      actions: All ground actions.
      costs: Cost of each action, by its number.
      initial: Literals of the initial state and timed literals.
      count: Number of literals.
    """
    values = [UNREACHABLE] * count
    for literal in initial:
        values[literal] = INITIAL
    users, sizes = yield from _users(actions, count)
    pending: Iterable[GroundAction] = actions
    reached: dict[int, None] = {}
    relaxed = 0
    stirred = set(range(len(actions)))  # whose conditions have changed since the starts alone were tried
    while pending:
        changed: dict[int, Value] = {}
        for action in pending:
            relaxed += sizes[action.number]
            if relaxed >= PORTION:
                relaxed = 0
                yield
            if _relax(action, costs[action.number], values, changed) and action is actions[action.number]:
                reached.setdefault(action.number)
        for literal, value in changed.items():
            values[literal] = value
        numbers = sorted({number for literal in changed for number in users[literal]})
        stirred.update(numbers)
        pending = [actions[number] for number in numbers]
        if not pending:
            pending = _starts([actions[number] for number in sorted(stirred)], values)
            stirred.clear()
    return Estimates(tuple(values), tuple(v.cost for v in values), tuple(v.work for v in values), tuple(reached))


def _relax(action: GroundAction, cost: float, values: Sequence[Value], changed: dict[int, Value]) -> bool:
    """Improves the values of the action's effects, minimum by (cost, work); False if the action is not yet reached."""
    before = sum_of(_value(condition, values) for condition, _ in action.external_conditions)
    if before.cost == math.inf:
        return False
    for effect in action.effects:
        start = before
        if effect.conditions:
            start = sum_of([before, *(_value(condition, values) for condition, _ in effect.conditions)])
        duration = (action.shortest if effect.moment else 0) if action.duration_s else 1
        value = (min(start.cost + cost, MOST), min(start.work + 1, MOST), start.makespan + duration)
        old = changed.get(effect.literal) or values[effect.literal]
        if value < old and value[0] < math.inf:
            # the makespan never rises, whichever achiever is the cheapest
            changed[effect.literal] = Value(value[0], value[1], min(value[2], old.makespan))
    return True


def _starts(actions: Sequence[GroundAction], values: Sequence[Value]) -> list[GroundAction]:
    """The starts of actions with later conditions, as far as they reach literals that whole actions do not."""
    starts = []
    for action in actions:
        at_start = tuple([part for part in action.external_conditions if part[1][1] == 0])
        if len(at_start) < len(action.external_conditions):
            new = tuple([e for e in action.effects if e.moment == 0 and values[e.literal].cost == math.inf])
            start = replace(action, external_conditions=at_start, effects=new)
            reaches: dict[int, Value] = {}
            if new and _relax(start, 0.0, values, reaches) and reaches:
                starts.append(start)
    return starts


def _users(actions: Sequence[GroundAction], count: int) -> Generator[None, None, tuple[list[list[int]], list[int]]]:
    """The numbers of the actions whose conditions mention a literal, by literal; and of how many each action counts."""
    users: list[list[int]] = [[] for _ in range(count)]
    sizes: list[int] = []
    done = 0
    for action in actions:
        spanned = [*action.conditions, *(c for effect in action.effects for c in effect.conditions)]
        read = {literal for condition, _ in spanned for literal in literals_of(condition)}
        for literal in read:
            users[literal].append(action.number)
        sizes.append(1 + (max(len(read), len(spanned)) + len(action.effects)) // LITERALS_PER_ACTION)
        done += sizes[-1] - 1
        if done >= PORTION // LITERALS_PER_ACTION:
            done = 0
            yield
    return users, sizes


def literals_of(condition: GroundCondition) -> Iterable[int]:
    """The literals of a condition."""
    if isinstance(condition, int):
        return (condition,)
    return (literal for part in condition.parts for literal in literals_of(part))
