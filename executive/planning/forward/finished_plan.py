"""Converts a deordered sequence to a finished plan: steps by level, links by name, links from static facts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.forward.deordering import Deordered
from tailor.executive.planning.forward.strips_task import StripsAction
from tailor.executive.planning.ground.ground_formula import StaticWorld
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground.static_literals import static_literals
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Step


def finished_plan(sequence: Sequence[StripsAction], order: Deordered, task: GroundTask, world: StaticWorld) -> Plan:
    """The plan of a sequence; steps are numbered in its order, and start as early as the orderings allow."""
    names = [action.ground.name for action in sequence]
    steps = [Step(n + 1, name, float(level)) for n, (name, level) in enumerate(zip(names, order.levels(), strict=True))]
    steps.sort(key=lambda step: (step.start, -step.id))
    supports = _supports(order, len(names), task)
    links = [link for step in steps for link in _links(step.id, _static_of(step.action, world), supports)]
    links += _links(GOAL, static_literals([task.problem.goal], {}, world), supports)
    orderings = tuple((i + 1, j + 1) for i, j in order.pairs())
    return Plan(task.problem.name, task.problem.initial, tuple(steps), tuple(links), orderings, tick_s=task.grid.unit_s)


def _supports(order: Deordered, count: int, task: GroundTask) -> dict[int, list[Link]]:
    """The links by consumer."""
    found: dict[int, list[Link]] = {}
    for support in order.links:
        consumer = GOAL if support.consumer == count else support.consumer + 1
        link = Link(support.producer + 1, task.names[support.literal], consumer)
        found.setdefault(consumer, []).append(link)
    return found


def _links(consumer: int, static: Sequence[Literal], supports: dict[int, list[Link]]) -> Iterator[Link]:
    """A consumer's links: from static facts first, then the last condition's first, as a search lists them."""
    yield from (Link(0, literal, consumer) for literal in static)
    yield from reversed(supports.get(consumer, []))


def _static_of(action: Fact, world: StaticWorld) -> tuple[Literal, ...]:
    schema, binding = world.domain.bound(action)
    return static_literals((condition.formula for condition in schema.conditions), binding, world)
