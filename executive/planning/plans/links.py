"""Builds causal links, and the orderings that they require, for a plan whose steps are in a sound order."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from tailor.executive.planning.pddl.language import Domain, Literal
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Step
from tailor.executive.planning.plans.simulation import Requirement, simulate
from tailor.executive.planning.plans.state import Objects, fact_of


def links_of(plan: Plan, domain: Domain, problem: Problem) -> Iterator[Link]:
    """Links from the last achiever of each condition's literals; of a consumer the last condition first.

    Links for conditional effects follow: for the conditions of those that achieve a link's literal, and for the
    negated conditions of those that would undo it.
    """
    events = simulate(plan, domain, problem)
    pending: deque[tuple[Requirement, int]] = deque()
    for position, event in enumerate(events):
        pending.extend((requirement, position) for requirement in reversed(event.requirements))
    seen: set[tuple[Link, int]] = set()
    listed: set[Link] = set()
    while pending:
        requirement, position = pending.popleft()
        source, consumer = requirement.source, events[position].step
        link = Link(source.step, requirement.literal, consumer)
        if (link, position) in seen:
            continue
        seen.add((link, position))
        if link not in listed and source.step != consumer:
            listed.add(link)
            yield link
        pending.extend((condition, source.position) for condition in source.conditions)
        opposite = Literal(requirement.literal.fact, not requirement.literal.positive)
        for between in range(source.position + 1, position):
            pending.extend((kept, between) for kept in events[between].prevented.get(opposite, ()))


# --- orderings -----------------------------------------------------------------------------------
def orderings_for(plan: Plan, links: tuple[Link, ...], domain: Domain, problem: Problem) -> Iterator[tuple[int, int]]:
    """Pairs that the links require: producer before consumer, and steps that undo a link outside of it."""
    if plan.durative:  # the schedule as it stands
        yield from ((a.id, b.id) for a in plan.steps for b in plan.steps if a.start + a.duration <= b.start)
        return
    order = {0: -1, GOAL: len(plan.steps), **{step.id: n for n, step in enumerate(plan.steps)}}
    undoing: dict[Literal, list[int]] = {}
    objects = Objects(problem)
    for step in plan.steps:
        for literal in _undone(step, domain, objects):
            undoing.setdefault(literal, []).append(step.id)
    for link in links:
        if link.producer != 0 and link.consumer != GOAL:
            yield link.producer, link.consumer
        for other in undoing.get(link.literal, ()):
            if order[other] < order[link.producer]:
                yield other, link.producer
            elif order[other] > order[link.consumer]:
                yield link.consumer, other


def _undone(step: Step, domain: Domain, objects: Objects) -> frozenset[Literal]:
    """The literals that a step may make false."""
    action = next(action for action in domain.actions if action.name == step.action[0])
    binding = {p.name: a for p, a in zip(action.parameters, step.action[1:], strict=True)}
    return frozenset(
        Literal(fact_of(effect.atom, inner), not effect.positive)
        for effect in action.effects
        for inner in objects.bindings(effect.variables, binding)
    )
