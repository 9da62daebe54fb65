"""Builds causal links, and the orderings that they require, for a plan whose steps are in a sound order."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Iterator, Sequence

from tailor.executive.planning.pddl.language import Domain, Literal, fact_of
from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Step
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.semantics.simulation import Event, Requirement, simulate
from tailor.executive.planning.semantics.state import Objects

LINKS = 4  # as much work as the simulation of one step


def linking(plan: Plan, domain: Domain, objects: Objects) -> Work[tuple[Link, ...]]:
    """Links from the last achiever of each condition's literals; of a consumer the last condition first.

    Links for conditional effects follow: for the conditions of those that achieve a link's literal, and for the
    negated conditions of those that would undo it.
    """
    events = yield from simulate(plan, domain, objects)
    listed: dict[Link, None] = {}
    for count, link in enumerate(_links(events), 1):
        listed[link] = None
        if not count % LINKS:
            yield
    return tuple(link for link in listed if link.producer != link.consumer)


def _links(events: Sequence[Event]) -> Iterator[Link]:
    """The links, some repeatedly, and some of a step to itself."""
    preventing = [position for position, event in enumerate(events) if event.prevented]
    pending: deque[tuple[Requirement, int]] = deque()
    for position, event in enumerate(events):
        pending.extend((requirement, position) for requirement in reversed(event.requirements))
    seen: set[tuple[Link, int]] = set()
    while pending:
        requirement, position = pending.popleft()
        source = requirement.source
        link = Link(source.step, requirement.literal, events[position].step)
        if (link, position) in seen:
            continue
        seen.add((link, position))
        yield link
        pending.extend((condition, source.position) for condition in source.conditions)
        opposite = Literal(requirement.literal.fact, not requirement.literal.positive)
        for between in preventing[bisect_right(preventing, source.position) : bisect_left(preventing, position)]:
            pending.extend((kept, between) for kept in events[between].prevented.get(opposite, ()))


# --- orderings -----------------------------------------------------------------------------------
def orderings_for(plan: Plan, links: tuple[Link, ...], domain: Domain, objects: Objects) -> Work[list[tuple[int, int]]]:
    """Pairs that the links require: producer before consumer, and steps that undo a link outside of it.

    One portion for each step of a durative plan, else for each link.
    """
    pairs: list[tuple[int, int]] = []
    if plan.durative:  # the schedule as it stands; simultaneous steps that take no time have no order
        for a in plan.steps:
            pairs += [(a.id, b.id) for b in plan.steps if a.start < b.start and a.start + a.duration <= b.start]
            yield
        return pairs
    order = {0: -1, GOAL: len(plan.steps), **{step.id: n for n, step in enumerate(plan.steps)}}
    undoing: dict[Literal, list[int]] = {}
    for step in plan.steps:
        for literal in (yield from _undone(step, domain, objects)):
            undoing.setdefault(literal, []).append(step.id)
    yield
    for link in links:
        if link.producer != 0 and link.consumer != GOAL:
            pairs.append((link.producer, link.consumer))
        for other in undoing.get(link.literal, ()):
            if order[other] < order[link.producer]:
                pairs.append((other, link.producer))
            elif order[other] > order[link.consumer]:
                pairs.append((link.consumer, other))
        yield
    return pairs


def _undone(step: Step, domain: Domain, objects: Objects) -> Work[set[Literal]]:
    """The literals that a step may make false."""
    action, binding = domain.bound(step.action)
    undone: set[Literal] = set()
    for effect in action.effects:
        for inner in objects.paced_bindings(effect.variables, binding):
            if inner is None:
                yield
            else:
                undone.add(Literal(fact_of(effect.atom, inner), not effect.positive))
    return undone
