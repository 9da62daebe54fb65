"""The events of a plan in order of time; simultaneous ones together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from heapq import merge

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.problem import TimedLiteral
from tailor.executive.planning.plans.plan import Plan, Step

SAME_TIME_S = 1e-6  # events closer than this, or than half a tick, happen together


@dataclass(frozen=True, slots=True)
class Event:
    """The start or end of a step, or a timed literal; a step without duration happens as a whole at its start."""

    time: float
    rank: int  # order of simultaneous events: ends first
    label: str
    step: Step | None
    ends: bool
    added: frozenset[Fact] = frozenset()
    removed: frozenset[Fact] = frozenset()


def happenings(plan: Plan, timed: Sequence[TimedLiteral]) -> Iterator[list[Event]]:
    """Events grouped by time; without durations every event is a group.

    Lazy: most suffixes of a plan fail at their first event.
    """
    literals = [_literal_event(each) for each in sorted(timed, key=lambda each: each.time_s)]
    if plan.durative:
        yield from _grouped([*literals, *_ends(plan)], min(SAME_TIME_S, plan.tick_s / 2))
    else:
        steps = (_event(step, step.start, ends=False) for step in sorted(plan.steps, key=lambda step: step.start))
        yield from ([event] for event in merge(literals, steps, key=lambda event: event.time))


def _ends(plan: Plan) -> Iterator[Event]:
    """Both ends of each step."""
    for step in plan.steps:
        yield _event(step, step.start, ends=False)
        yield _event(step, step.start + step.duration, ends=True, rank=0)


def _event(step: Step, time: float, ends: bool, rank: int = 1) -> Event:
    return Event(time, rank, f"step {step.id}", step, ends)


def _grouped(events: Iterable[Event], same_s: float) -> Iterator[list[Event]]:
    """Events in order of time, those within `same_s` of the first of a group together."""
    group: list[Event] = []
    for event in sorted(events, key=lambda event: (event.time, event.rank)):
        if group and event.time - group[0].time > same_s:
            yield group
            group = []
        group.append(event)
    if group:
        yield group


def _literal_event(timed: TimedLiteral) -> Event:
    facts, none = frozenset([timed.literal.fact]), frozenset[Fact]()
    added, removed = (facts, none) if timed.literal.positive else (none, facts)
    return Event(timed.time_s, 0, f"the timed literal {format_atom(timed.literal.fact)}", None, False, added, removed)
