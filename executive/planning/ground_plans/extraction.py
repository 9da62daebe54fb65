"""Converts a partial plan without flaws to a finished plan: schedule, links by name, links from static facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld, bindings
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground.static_literals import static_literals
from tailor.executive.planning.ground_plans.events import events_of
from tailor.executive.planning.ground_plans.partial_plan import PartialPlan
from tailor.executive.planning.ground_plans.separation import Schedule, separated
from tailor.executive.planning.pddl.language import Action, Literal, fact_of
from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Step
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.orderings import Orderings
from tailor.executive.planning.structures.temporal_network import TemporalNetwork


@dataclass(frozen=True, slots=True)
class Frame:
    """The actions of a finished plan of a task, and the orderings of their nodes."""

    names: tuple[Fact, ...]
    orderings: Orderings
    task: GroundTask

    def steps(self) -> tuple[Step, ...]:
        """The steps by start time; of simultaneous ones the newest first, as VHPOP prints them."""
        times, grid, temporal = self.orderings.earliest(), self.task.grid, self.task.temporal
        steps = []
        for number, name in enumerate(self.names, 1):
            node = self.task.node_of(number)
            duration = grid.seconds(times[node + 1] - times[node]) if temporal else 1.0
            start = grid.seconds(times[node]) if temporal else float(times[node])
            steps.append(Step(number, name, start, duration))
        return tuple(sorted(steps, key=lambda step: (step.start, -step.id)))

    def pairs(self) -> Iterator[tuple[int, int]]:
        """The pairs (i, j) of steps where i must end before j starts."""
        nodes = [(step, self.task.node_of(step)) for step in range(1, len(self.names) + 1)]
        for i, first in nodes:
            after = self.orderings.not_before(first + self.task.moments - 1)
            yield from ((i, j) for j, node in nodes if i != j and after >> node & 1)

    def bounds(self) -> tuple[tuple[int | None, ...], ...]:
        """The temporal network's bounds without the nodes of the goal and of timed literals; () without durations."""
        if not isinstance(self.orderings, TemporalNetwork):
            return ()
        bounds = self.orderings.bounds()  # without the goal's row and column
        kept = [0, *range(self.task.first_node - 1, len(bounds))]
        return tuple(tuple(bounds[i][j] for j in kept) for i in kept)

    def plan(self, links: Iterable[Link], bindings: tuple[str, ...] = ()) -> Plan:
        """The plan, each step as early as the orderings allow."""
        task = self.task
        return Plan(
            task.problem.name,
            task.problem.initial,
            self.steps(),
            tuple(links),
            tuple(self.pairs()),
            task.temporal,
            self.bounds(),
            task.grid.unit_s,
            bindings,
        )


def scheduled(orderings: Orderings, names: tuple[Fact, ...], task: GroundTask, world: StaticWorld) -> Schedule | None:
    """The orderings of a plan without flaws, with interfering events apart; None if they cannot be.

    Raises:
      UnsettledError: As `separated`.
    """
    if not isinstance(orderings, TemporalNetwork):  # the steps follow one another
        return Schedule(orderings)

    def simulated(network: TemporalNetwork) -> Work[str]:
        # loaded here: few plans have effects of which only a simulation tells whether they happen
        from tailor.executive.planning.semantics.state import Objects
        from tailor.executive.planning.semantics.validator import validation

        return validation(Frame(names, network, task).plan(()), world.domain, Objects(task.problem))

    return separated(orderings, events_of(names, task.problem, world, orderings.late), simulated)


def schedule(plan: PartialPlan, task: GroundTask, world: StaticWorld) -> Schedule | None:
    """As `scheduled`, of a ground plan."""
    return scheduled(plan.orderings, _names(plan), task, world)


def _names(plan: PartialPlan) -> tuple[Fact, ...]:
    return tuple(action.name for action in plan.steps)


def extract(plan: PartialPlan, task: GroundTask, world: StaticWorld) -> Plan:
    """The finished plan of a ground search; there is a schedule of it."""
    found = schedule(plan, task, world)
    assert found is not None
    frame = Frame(_names(plan), found.orderings, task)
    return frame.plan(_links(plan, task, world, frame.steps()))


def _links(plan: PartialPlan, task: GroundTask, world: StaticWorld, steps: tuple[Step, ...]) -> Iterator[Link]:
    """Links by consumer; links from static facts, which grounding removes, are added as the newest."""
    links_by_consumer: dict[int, list[Link]] = {}
    for cell in cells_of(plan.links):
        link = Link(task.step_of(cell.producer), task.names[cell.literal], task.step_of(cell.first))
        if link not in links_by_consumer.setdefault(link.consumer, []):
            links_by_consumer[link.consumer].append(link)
    for step in steps:
        schema, binding = world.domain.bound(step.action)
        achieved = (link.literal for links in links_by_consumer.values() for link in links if link.producer == step.id)
        static = dict.fromkeys(static_literals((condition.formula for condition in schema.conditions), binding, world))
        static.update(dict.fromkeys(x for literal in achieved for x in _static_guard(schema, binding, literal, world)))
        yield from (Link(0, literal, step.id) for literal in static)
        yield from links_by_consumer.get(step.id, ())
    yield from (Link(0, literal, GOAL) for literal in static_literals([task.problem.goal], {}, world))
    yield from links_by_consumer.get(GOAL, ())


def _static_guard(schema: Action, binding: Binding, achieved: Literal, world: StaticWorld) -> tuple[Literal, ...]:
    """The static conditions of the conditional effect that achieves a literal."""
    for effect in schema.effects:
        if (effect.atom.predicate, effect.positive) == (achieved.fact[0], achieved.positive):
            formulas = [condition.formula for condition in effect.condition]
            for inner in bindings(effect.variables, binding, world):
                if fact_of(effect.atom, inner) == achieved.fact:
                    static = static_literals(formulas, inner, world)
                    if all(x.holds_in(world.facts) for x in static):
                        return static
    return ()
