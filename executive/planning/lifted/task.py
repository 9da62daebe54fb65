"""The task of a lifted search: schemata, initial facts, goal, and estimates borrowed from the ground relaxed graph."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from executive.library import Fact
from executive.planning.additive_heuristic import NOTHING, UNREACHABLE, Value
from executive.planning.ground_formula import World
from executive.planning.ground_task import CostOf, GroundTask
from executive.planning.lifted.bindings import Bindings
from executive.planning.lifted.schema import LiftedLiteral, Schema, UnsupportedLifted, conjuncts, schemata
from executive.planning.orderings import FIRST

Pattern = tuple[str, bool, tuple[str | None, ...]]  # predicate, positive, objects where they are known


@dataclass(frozen=True, slots=True, eq=False)
class LiftedTask:
    """What a lifted search plans with. `values` remembers estimates by pattern; it never changes an answer."""

    ground: GroundTask
    world: World
    schemata: tuple[Schema, ...]
    initial: dict[str, tuple[Fact, ...]]  # by predicate, in the problem's order
    goal: tuple[LiftedLiteral, ...]
    costs: dict[str, float]  # by schema
    values: dict[Pattern, Value] = field(default_factory=dict)

    @property
    def first_node(self) -> int:
        """The node of the first step."""
        return FIRST + len(self.ground.timed)

    @property
    def moments(self) -> int:
        """Nodes of a step."""
        return self.ground.moments

    def step_of(self, node: int) -> int:
        """The step of a node: 0 is the initial state, -1 the goal."""
        if node < self.first_node:
            return -1 if node == 1 else 0
        return 1 + (node - self.first_node) // self.moments

    def node_of(self, step: int) -> int:
        """The first node of a step."""
        return self.first_node + (step - 1) * self.moments

    def value(self, literal: LiftedLiteral, bindings: Bindings) -> Value:
        """The least estimate of any ground literal that fits what is known of the terms."""
        known = tuple(bindings.value(term) for term in literal.terms)
        pattern = (literal.predicate, literal.positive, known)
        value = self.values.get(pattern)
        if value is None:
            value = self.values[pattern] = min(self._fitting(pattern), default=UNREACHABLE)
        return value

    def _fitting(self, pattern: Pattern) -> Iterator[Value]:
        predicate, positive, known = pattern
        if predicate in self.world.static:
            found = any(_fits(fact, known) for fact in self.initial.get(predicate, ()))
            yield NOTHING if found or not positive else UNREACHABLE
            return
        for number, name in enumerate(self.ground.names):
            if name.positive == positive and name.fact[0] == predicate and _fits(name.fact, known):
                yield self.ground.estimates.values[number]
        if not positive:
            yield NOTHING._replace(work=1)  # facts that no action speaks of are false from the start


def _fits(fact: Fact, known: tuple[str | None, ...]) -> bool:
    return all(name is None or name == own for name, own in zip(known, fact[1:], strict=True))


def lifted_task(ground: GroundTask, world: World, cost: CostOf = "unit") -> LiftedTask:
    """The lifted task of a problem.

    Raises:
      UnsupportedLifted: A feature of domain or goal that lifted planning does not speak.
    """
    problem = ground.problem
    if problem.timed:
        raise UnsupportedLifted("the problem: timed initial literals")
    goal = []
    for part in conjuncts(problem.goal, "the goal"):
        if not isinstance(part, LiftedLiteral):
            raise UnsupportedLifted("the goal: an equality")
        goal.append(part)
    initial: dict[str, list[Fact]] = {}
    for fact in problem.initial:
        initial.setdefault(fact[0], []).append(fact)
    made = schemata(world, ground.tick_s)
    costs = _costs(made, cost)
    facts = {predicate: tuple(own) for predicate, own in initial.items()}
    return LiftedTask(ground, world, made, facts, tuple(goal), costs)


def _costs(made: tuple[Schema, ...], kind: CostOf) -> dict[str, float]:
    """By schema, 1, its duration in seconds, or that relative to the shortest one."""
    durations = {schema.name: schema.duration_s or 1.0 for schema in made}
    if kind == "unit" or not durations:
        return dict.fromkeys(durations, 1.0)
    unit = min(durations.values()) if kind == "relative" else 1.0
    return {name: duration / unit for name, duration in durations.items()}
