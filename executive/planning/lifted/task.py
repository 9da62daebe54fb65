"""The task of a lifted search: schemata, initial facts, goal, and estimates borrowed from the ground relaxed graph."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from executive.library import Fact
from executive.planning.additive_heuristic import NOTHING, UNREACHABLE, Value
from executive.planning.ground_formula import Facts, World
from executive.planning.ground_task import CostOf, GroundTask
from executive.planning.language import Typed
from executive.planning.lifted.effects import LiftedEffect
from executive.planning.lifted.formula import LiftedFormula, LiftedLiteral
from executive.planning.lifted.lowering import Lowering
from executive.planning.lifted.schema import Schema, schemata
from executive.planning.orderings import FIRST

Pattern = tuple[str, bool, tuple[str | None, ...]]  # predicate, positive, objects where they are known
Achiever = tuple[Schema, LiftedEffect]


class Placed(NamedTuple):
    """An effect of a step (0: a timed literal) at its node of a plan, with the variables of the step."""

    node: int
    step: int
    literal: LiftedLiteral
    effect: LiftedEffect


@dataclass(frozen=True, slots=True, eq=False)
class LiftedTask:
    """What a lifted search plans with. `values` and `placed` only remember; they never change an answer."""

    ground: GroundTask
    world: World
    initial: dict[str, tuple[Fact, ...]]  # by predicate, in the problem's order
    goal: LiftedFormula
    goal_variables: tuple[Typed, ...]  # of "exists"
    timed: tuple[Placed, ...]  # the timed literals
    achievers: dict[tuple[str, bool], tuple[Achiever, ...]]  # by predicate and sign
    costs: dict[Schema, float]
    values: dict[Pattern, Value] = field(default_factory=dict)
    placed: dict[tuple[Schema, int], tuple[Placed, ...]] = field(default_factory=dict)

    @property
    def first_node(self) -> int:
        """The node of the first step."""
        return self.ground.first_node

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

    def effects_of(self, schema: Schema, step: int) -> tuple[Placed, ...]:
        """The effects of a schema as a step of a plan."""
        placed = self.placed.get((schema, step))
        if placed is None:
            node = self.node_of(step)
            placed = tuple(Placed(node + e.moment, step, e.literal.of_step(step), e) for e in schema.effects)
            self.placed[schema, step] = placed
        return placed

    # --- estimates -------------------------------------------------------------------------------
    def value(self, predicate: str, positive: bool, known: tuple[str | None, ...]) -> Value:
        """The least estimate of any ground literal that fits what is known of the terms."""
        pattern = (predicate, positive, known)
        value = self.values.get(pattern)
        if value is None:
            value = self.values[pattern] = min(self._fitting(pattern), default=UNREACHABLE)
        return value

    def _fitting(self, pattern: Pattern) -> Iterator[Value]:
        predicate, positive, known = pattern
        if predicate in self.world.static:
            found = sum(_fits(fact, known) for fact in self.initial.get(predicate, ()))
            if (found > 0) if positive else (found == 0 or None in known):
                yield NOTHING
            return
        spoken = False
        for number, name in enumerate(self.ground.names):
            if name.positive == positive and name.fact[0] == predicate and _fits(name.fact, known):
                spoken = True
                yield self.ground.estimates.values[number]
        if not positive and not (spoken and None not in known):
            yield NOTHING._replace(work=1)  # facts that no action speaks of are false from the start


def _fits(fact: Fact, known: tuple[str | None, ...]) -> bool:
    return all(name is None or name == own for name, own in zip(known, fact[1:], strict=True))


def lifted_task(ground: GroundTask, world: World, cost: CostOf = "unit") -> LiftedTask:
    """The lifted task of a problem.

    Raises:
      TooMuchToGround: Universal quantifiers or durations bring too many formulas.
    """
    problem, work = ground.problem, Facts()
    initial: dict[str, list[Fact]] = {}
    for fact in problem.initial:
        initial.setdefault(fact[0], []).append(fact)
    made = schemata(world, ground.tick_s, work)
    numbers = itertools.count(1 + sum(len(action.parameters) for action in world.domain.actions))
    lowering = Lowering(world, numbers, work)  # its variables are the goal's: they meet no schema's
    goal = lowering.lowered(problem.goal, {})
    literals = (LiftedLiteral(t.literal.fact[0], t.literal.fact[1:], t.literal.positive) for t in problem.timed)
    return LiftedTask(
        ground,
        world,
        {predicate: tuple(own) for predicate, own in initial.items()},
        goal,
        tuple(lowering.variables),
        tuple(Placed(FIRST + n, 0, literal, LiftedEffect(literal, 0)) for n, literal in enumerate(literals)),
        _achievers(made),
        _costs(made, cost),
    )


def _achievers(made: tuple[Schema, ...]) -> dict[tuple[str, bool], tuple[Achiever, ...]]:
    found: dict[tuple[str, bool], list[Achiever]] = {}
    for schema in made:
        for effect in schema.effects:
            found.setdefault((effect.literal.predicate, effect.literal.positive), []).append((schema, effect))
    return {key: tuple(own) for key, own in found.items()}


def _costs(made: tuple[Schema, ...], kind: CostOf) -> dict[Schema, float]:
    """By schema, 1, its duration in seconds, or that relative to the shortest one."""
    durations = {schema: schema.duration_s or 1.0 for schema in made}
    if kind == "unit" or not durations:
        return dict.fromkeys(durations, 1.0)
    unit = min(durations.values()) if kind == "relative" else 1.0
    return {schema: duration / unit for schema, duration in durations.items()}
