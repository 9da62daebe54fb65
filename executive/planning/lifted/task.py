"""The task of a lifted search: schemata, initial facts, goal, and estimates from the ground relaxed graph."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.additive_heuristic import NOTHING, PORTION, UNREACHABLE, Value, action_costs
from tailor.executive.planning.ground.ground_formula import GroundingLimit, StaticWorld, TooMuchToGround
from tailor.executive.planning.ground.ground_task import CostOf, GroundTask
from tailor.executive.planning.lifted.effects import LiftedEffect
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral
from tailor.executive.planning.lifted.lifter import Lifter, Paced
from tailor.executive.planning.lifted.schema import Schema, schemata, shuffled
from tailor.executive.planning.pddl.language import Typed
from tailor.executive.planning.structures.connectives import Conjunction
from tailor.executive.planning.structures.orderings import FIRST
from tailor.executive.planning.structures.random_source import RandomSource

LiteralPattern = tuple[str, bool, tuple[str | None, ...]]  # predicate, positive, objects (None: unbound)
ArgumentKey = tuple[str, bool, int, str]  # predicate, positive, argument position (-1: none), object
Achiever = tuple[Schema, LiftedEffect]
MAX_COMPARED = 250_000  # conditions of one step times effects of another, for each plan: a tenth of a second
MAX_FORMULAS = 50_000  # a quarter of a second; only "forall" over many objects comes near


class PlacedEffect(NamedTuple):
    """An effect of a step (0: a timed literal) at its node of a plan, with the variables of the step."""

    node: int
    step: int
    literal: LiftedLiteral
    effect: LiftedEffect


@dataclass(frozen=True, slots=True, eq=False)
class LiftedTask:
    """A lifted planning problem. `values` and `placed` are caches, filled on use."""

    ground: GroundTask
    world: StaticWorld
    initial: dict[str, tuple[Fact, ...]]  # facts by predicate, in the problem's order
    goal: LiftedFormula
    goal_variables: tuple[Typed, ...]  # bound by "exists" in the goal
    timed: tuple[PlacedEffect, ...]  # the timed literals
    achievers: dict[tuple[str, bool], tuple[Achiever, ...]]  # by predicate and sign
    costs: dict[Schema, float]
    names: dict[ArgumentKey, list[int]]  # ground literals by an object among their arguments
    values: dict[LiteralPattern, Value]
    placed: dict[tuple[Schema, int], tuple[PlacedEffect, ...]] = field(default_factory=dict)

    def effects_of(self, schema: Schema, step: int) -> tuple[PlacedEffect, ...]:
        """The effects of a schema as a step of a plan."""
        placed = self.placed.get((schema, step))
        if placed is None:
            node = self.ground.node_of(step)
            placed = tuple(PlacedEffect(node + e.moment, step, e.literal.of_step(step), e) for e in schema.effects)
            self.placed[schema, step] = placed
        return placed

    # --- estimates -------------------------------------------------------------------------------
    def value(self, predicate: str, positive: bool, terms: tuple[str | None, ...]) -> Value:
        """The least estimate of the ground literals that match the bound terms."""
        pattern = (predicate, positive, terms)
        value = self.values.get(pattern)
        if value is None:
            value = self.values[pattern] = min(self._matching_values(pattern), default=UNREACHABLE)
        return value

    def _matching_values(self, pattern: LiteralPattern) -> Iterator[Value]:
        predicate, positive, terms = pattern
        if predicate in self.world.static:
            matches = sum(_matches(fact, terms) for fact in self.initial.get(predicate, ()))
            if (matches > 0) if positive else (matches == 0 or None in terms):
                yield NOTHING
            return
        if None in terms:  # `values` holds the fully bound ones from the start
            for number in self._candidates(pattern):
                if _matches(self.ground.names[number].fact, terms):
                    yield self.ground.estimates.values[number]
        if not positive:
            yield NOTHING._replace(work=1)  # facts that no action mentions are false initially

    def _candidates(self, pattern: LiteralPattern) -> list[int]:
        """The ground literals of a predicate and sign that share the rarest bound object of the pattern."""
        predicate, positive, terms = pattern
        keys = [(predicate, positive, n, name) for n, name in enumerate(terms) if name is not None]
        lists = [self.names.get(key, []) for key in keys or [(predicate, positive, -1, "")]]
        return min(lists, key=len)


def _matches(fact: Fact, terms: tuple[str | None, ...]) -> bool:
    return all(name is None or name == own for name, own in zip(terms, fact[1:], strict=True))


def lifted_task(
    ground: GroundTask, world: StaticWorld, cost: CostOf = "unit", rng: RandomSource | None = None
) -> Paced[LiftedTask]:
    """The lifted task of a problem; with `rng`, conditions are in random order. Yields after each portion.

    Raises:
      TooMuchToGround: Universal quantifiers, durations or costs exceed the limit of formulas, or leave too many
        conditions and effects.
    """
    problem, limit = ground.problem, GroundingLimit(MAX_FORMULAS)
    initial: dict[str, list[Fact]] = {}
    for fact in problem.initial:
        initial.setdefault(fact[0], []).append(fact)
    schemas = yield from schemata(world, ground.grid, limit)
    if rng is not None:
        schemas = tuple(shuffled(schema, rng) for schema in schemas)
    numbers = itertools.count(1 + sum(len(action.parameters) for action in world.domain.actions))
    limit.subject = "the goal"
    lifter = Lifter(world, numbers, limit)  # of the goal's variables, numbered after those of the schemata
    goal = yield from lifter.lift(problem.goal, {})
    _check_sizes(schemas, goal)
    yield
    by_argument = _literals_by_argument(ground)
    if len(ground.names) > PORTION:
        yield
    literals = (LiftedLiteral(t.literal.fact[0], t.literal.fact[1:], t.literal.positive) for t in problem.timed)
    return LiftedTask(
        ground,
        world,
        {predicate: tuple(own) for predicate, own in initial.items()},
        goal,
        tuple(lifter.variables),
        tuple(PlacedEffect(FIRST + n, 0, literal, LiftedEffect(literal, 0)) for n, literal in enumerate(literals)),
        _achievers(schemas),
        dict(zip(schemas, action_costs([(each.cost, each.duration_s) for each in schemas], cost), strict=True)),
        by_argument,
        {(n.fact[0], n.positive, n.fact[1:]): v for n, v in zip(ground.names, ground.estimates.values, strict=True)},
    )


def _check_sizes(schemas: tuple[Schema, ...], goal: LiftedFormula) -> None:
    """Raises TooMuchToGround if a single plan of a few steps would take too long to rank."""
    conditions = {f"'{schema.name}'": len(schema.conditions) for schema in schemas}
    conditions["the goal"] = len(goal.parts) if isinstance(goal, Conjunction) else 1
    effects = {f"'{schema.name}'": len(schema.effects) for schema in schemas}
    user = max(conditions, key=lambda name: conditions[name])
    maker = max(effects, key=lambda name: effects[name], default="")
    if effects and conditions[user] * effects[maker] > MAX_COMPARED:
        raise TooMuchToGround(
            f"{conditions[user]} conditions of {user} and {effects[maker]} effects of {maker} "
            "are too many for planning with variables"
        )


def _literals_by_argument(ground: GroundTask) -> dict[ArgumentKey, list[int]]:
    literals: dict[ArgumentKey, list[int]] = {}
    for number, (predicate, *terms) in enumerate(name.fact for name in ground.names):
        positive = ground.names[number].positive
        for argument in ((-1, ""), *enumerate(terms)):
            literals.setdefault((predicate, positive, *argument), []).append(number)
    return literals


def _achievers(schemas: tuple[Schema, ...]) -> dict[tuple[str, bool], tuple[Achiever, ...]]:
    matches: dict[tuple[str, bool], list[Achiever]] = {}
    for schema in schemas:
        for effect in schema.effects:
            matches.setdefault((effect.literal.predicate, effect.literal.positive), []).append((schema, effect))
    return {key: tuple(own) for key, own in matches.items()}
