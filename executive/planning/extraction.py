"""Turns a partial plan without flaws into the plan that is handed over: schedule, links in words, static links."""

from __future__ import annotations

from collections.abc import Iterator

from executive.library import Fact
from executive.planning.ground_formula import World
from executive.planning.ground_task import GroundTask
from executive.planning.language import And, Atom, Formula, Literal, Not
from executive.planning.orderings import GOAL as GOAL_NODE
from executive.planning.partial_plan import PartialPlan, first_node, step_of
from executive.planning.plan import GOAL, Link, Plan, Step
from executive.planning.temporal_network import TemporalNetwork


def extract(plan: PartialPlan, task: GroundTask, world: World) -> Plan:
    """The plan in words, each step as early as the orderings allow."""
    steps = _steps(plan, task)
    orderings = plan.orderings
    network = orderings if isinstance(orderings, TemporalNetwork) else None
    return Plan(
        task.problem.name,
        task.problem.initial,
        steps,
        tuple(_links(plan, task, world, steps)),
        tuple(_pairs(plan, task)),
        network is not None,
        _without_timed(network, task) if network else (),
        task.tick_s,
    )


def _steps(plan: PartialPlan, task: GroundTask) -> tuple[Step, ...]:
    """The steps by start time; of those that start together the newest first, as VHPOP prints them."""
    times = plan.orderings.earliest()
    first, moments, tick = first_node(task), task.moments, task.tick_s if task.temporal else 1.0
    steps = []
    for number, action in enumerate(plan.steps, 1):
        node = first + (number - 1) * moments
        duration = round((times[node + 1] - times[node]) * tick, 9) if task.temporal else 1.0
        steps.append(Step(number, action.name, round(times[node] * tick, 9), duration))
    return tuple(sorted(steps, key=lambda step: (step.start, -step.id)))


def _pairs(plan: PartialPlan, task: GroundTask) -> Iterator[tuple[int, int]]:
    late = plan.orderings.late
    first, moments = first_node(task), task.moments
    count = len(plan.steps)
    for i in range(count):
        end = late[first + i * moments + moments - 1]
        for j in range(count):
            if i != j and end >> (first + j * moments) & 1:
                yield i + 1, j + 1


def _links(plan: PartialPlan, task: GroundTask, world: World, steps: tuple[Step, ...]) -> Iterator[Link]:
    """Links by consumer; those from static facts, which the search never saw, count as the newest."""
    found: dict[int, list[Link]] = {}
    cell = plan.links
    while cell is not None:
        link = Link(step_of(task, cell.producer), task.names[cell.literal], step_of(task, cell.first))
        if link not in found.setdefault(link.consumer, []):
            found[link.consumer].append(link)
        cell = cell.rest
    schemata = {action.name: action for action in world.domain.actions}
    for step in steps:
        schema = schemata[step.action[0]]
        binding = {p.name: name for p, name in zip(schema.parameters, step.action[1:], strict=True)}
        formula = And(tuple(condition.formula for condition in schema.conditions))
        yield from (Link(0, literal, step.id) for literal in static_literals(formula, binding, world))
        yield from found.get(step.id, ())
    yield from (Link(0, literal, GOAL) for literal in static_literals(task.problem.goal, {}, world))
    yield from found.get(GOAL, ())


def static_literals(formula: Formula, binding: dict[str, str], world: World) -> tuple[Literal, ...]:
    """The static literals that a formula demands outright, without disjunctions; the last one first."""
    found: list[Literal] = []
    pending = [formula]
    while pending:
        part = pending.pop()
        inner, positive = (part.part, False) if isinstance(part, Not) else (part, True)
        if isinstance(part, And):
            pending += part.parts
        elif isinstance(inner, Atom) and inner.predicate in world.static:
            fact: Fact = (inner.predicate, *(binding.get(term, term) for term in inner.terms))
            if Literal(fact, positive) not in found:
                found.append(Literal(fact, positive))
    return tuple(found)


def _without_timed(network: TemporalNetwork, task: GroundTask) -> tuple[tuple[int | None, ...], ...]:
    """The network's bounds without the nodes of timed literals."""
    bounds = network.bounds()  # the goal is already gone
    kept = [0, *range(first_node(task) - 1, len(bounds))]
    assert GOAL_NODE == 1
    return tuple(tuple(bounds[i][j] for j in kept) for i in kept)
